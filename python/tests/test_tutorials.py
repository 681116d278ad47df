"""Tutorials run as they stand: each block of Python does what it says, and prints what stands under it.

    python python/tests/test_tutorials.py     puts outputs and pictures into the pages anew
"""

import contextlib
import io
import os
import re
import tempfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted((ROOT / "docs/tutorials").glob("*.md"))
BLOCK = re.compile(r"```python\n(?P<code>.*?)```\n(?:\n```text\n(?P<printed>.*?)```\n)?", re.DOTALL)
PICTURE = re.compile(r"!\[[^\]]*\]\((?P<name>[^)]*\.svg)\)")


def run(page, folder):
    """Runs a page in a folder that has the examples; what each block printed, beside what the page says."""
    (folder / "examples").symlink_to(ROOT / "examples")
    names = {"__name__": "__main__"}
    with contextlib.chdir(folder):
        for block in BLOCK.finditer(page.read_text(encoding="utf-8")):
            out = io.StringIO()
            # Lines of an exception are those of the page.
            line = page.read_text(encoding="utf-8")[: block.start("code")].count("\n")
            with contextlib.redirect_stdout(out):
                exec(compile("\n" * line + block["code"], page, "exec"), names)
            yield block, out.getvalue()


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_tutorials_do_what_they_say(page, tmp_path):
    pytest.importorskip("matplotlib")
    for block, printed in run(page, tmp_path):
        assert printed == (block["printed"] or ""), block["code"]
    pictures = {found["name"] for found in PICTURE.finditer(page.read_text(encoding="utf-8"))}
    assert pictures, "no picture"
    for name in pictures:
        assert (tmp_path / name).stat().st_size > 1000 and (page.parent / name).exists(), name


def main():
    for page in PAGES:
        text, fresh, last = page.read_text(encoding="utf-8"), [], 0
        with tempfile.TemporaryDirectory() as folder:
            for block, printed in run(page, Path(folder)):
                shown = f"```python\n{block['code']}```\n" + (f"\n```text\n{printed}```\n" if printed else "")
                fresh += [text[last : block.start()], shown]
                last = block.end()
            for name in {found["name"] for found in PICTURE.finditer(text)}:
                (page.parent / name).write_bytes((Path(folder) / name).read_bytes())
        page.write_text("".join([*fresh, text[last:]]), encoding="utf-8")


if __name__ == "__main__":
    os.environ.setdefault("SOURCE_DATE_EPOCH", "0")
    main()
