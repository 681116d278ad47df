"""Licence texts of all that is linked, from the lock file: into every FMU's library, and into the command and the Python
package.

    python3 .ci/licenses.py            writes the files
    python3 .ci/licenses.py --check    fails where they are not what it would write

They are taken from the packages as cargo unpacked them, every file of a licence, so also those of code that a package took over,
which the licence in its manifest does not name (faer's of Eigen, LAPACK and SuiteSparse). Of packages to be had under MIT or
Apache-2.0 the text of MIT is given, with its copyright. Packages that run in the compiler alone are left out.
"""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LICENSE_FILE = re.compile(r"(?i)(licen[cs]e|copying|notice|copyright)")

FMU = """\
The libraries in binaries/ are the runtime of orthopanel, under the MIT licence or the Apache licence 2.0, at your option: both
follow. What else is linked into them follows after these, each with its licence; the Rust standard library's stand in
rust-standard-library.html beside this file. What this FMU tells of its panel (its description, its resources and the rest of its
documentation) belongs to whoever exported it.
"""
COMMAND = """\
orthopanel is under the MIT licence or the Apache licence 2.0, at your option: LICENSE-MIT, LICENSE-APACHE. What is linked into
the command and the Python package follows, each with its licence; the Rust standard library's stand in
crates/orthopanel-export/licenses/rust-standard-library.html. FMUs carry their own in documentation/licenses.
"""


def cargo(*words):
    return subprocess.run(["cargo", *words, "--locked"], cwd=ROOT, check=True, capture_output=True, text=True).stdout


def linked(*selection):
    """Name and version of every package linked, on any of the systems of deny.toml."""
    targets = tomllib.loads((ROOT / "deny.toml").read_text())["graph"]["targets"]
    asked = [word for target in targets for word in ("--target", target)]
    tree = cargo("tree", "--edges", "normal,no-proc-macro", "--prefix", "none", "--format", "{p}", *asked, *selection)
    return {tuple(line.split()[:2]) for line in tree.splitlines() if line}


def texts(package):
    """Each licence text that a package brings; of MIT in general where it brings none."""
    folder = Path(package["manifest_path"]).parent
    files = sorted(path for path in folder.iterdir() if path.is_file() and LICENSE_FILE.match(path.name))
    if any("MIT" in path.name.upper() for path in files):
        files = [path for path in files if "APACHE" not in path.name.upper()]
    found = ["\n".join(line.rstrip() for line in path.read_text().strip().splitlines()) for path in files]
    # Files of taken over code alone are no licence of the package.
    if all(path.name.startswith("COPYING.") for path in files):
        if not re.search(r"\b(MIT|BSD-2-Clause)\b", package["license"]):
            raise SystemExit(f"{package['name']} {package['version']} brings no text of {package['license']}")
        general = ROOT / ".ci/license-texts" / ("MIT.txt" if "MIT" in package["license"] else "BSD-2-Clause.txt")
        holders = ", ".join(package["authors"]) or f"the authors of {package['name']}"
        found.insert(0, f"Copyright (c) {holders}\n\n{general.read_text().strip()}")
    return found


def document(head, own, *selection):
    packages = {(p["name"], "v" + p["version"]): p for p in json.loads(cargo("metadata", "--format-version", "1"))["packages"]}
    users = {}
    for name in sorted(linked(*selection)):
        package = packages[name]
        # A package of this workspace has no source: its licence is the head's.
        for text in texts(package) if package["source"] else ():
            users.setdefault(text, []).append(package)
    parts = [head.strip()] + [(ROOT / path).read_text().strip() for path in own]
    for text, packages in users.items():
        lines = [f"{p['name']} {p['version']} ({p['license']}), {p['repository'] or 'crates.io'}" for p in packages]
        parts.append("\n".join(lines) + "\n\n" + text)
    return ("\n\n" + "-" * 80 + "\n\n").join(parts) + "\n"


def main():
    written = {
        "crates/orthopanel-export/licenses/license.txt": document(
            FMU, ["LICENSE-MIT", "LICENSE-APACHE"], "--package", "orthopanel-fmu", "--features", "compact"
        ),
        "THIRD-PARTY-LICENSES.txt": document(COMMAND, [], "--package", "orthopanel-cli", "--package", "orthopanel-py"),
    }
    for name, text in written.items():
        path = ROOT / name
        if "--check" not in sys.argv:
            path.write_text(text)
        elif not path.exists() or path.read_text() != text:
            raise SystemExit(f"{name} does not tell what is linked: run python3 .ci/licenses.py")


if __name__ == "__main__":
    main()
