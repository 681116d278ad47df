"""From a model file's content to an FMU, by the command under test."""

import json
import os
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent


def run_export(content, path, *options, forces=(), responses=()):
    """Runs `orthopanel export` on a model file beside `path`; ports are x, or (x, y)."""
    source = path.with_suffix(".json")
    source.write_text(json.dumps(content))
    command = os.environ.get("ORTHOPANEL", str(ROOT / "target/release/orthopanel"))
    words = [command, "export", str(source), "-o", str(path), *options]
    for kind, places in (("force", forces), ("response", responses)):
        words += [f"--{kind}={','.join(map(str, coordinates(place)))}" for place in places]
    return subprocess.run(words, capture_output=True, text=True, cwd=ROOT)


def coordinates(place):
    return place if isinstance(place, tuple) else (place,)


def exporter(folder, content, forces, responses, modes):
    """The fixture `export`: exports the panel with these ports, or others, to a file of a name; returns its path.

    Without residual modes unless the options ask for them: what is compared with the sum over the modes kept has no others.
    """
    usual = modes, forces

    def export(name, *options, modes=usual[0], forces=usual[1], responses=responses, **changes):
        path = folder / name
        options = options if "--residual" in options else (*options, "--residual", "none")
        done = run_export(content(**changes), path, "--modes", str(modes), *options, forces=forces, responses=responses)
        assert done.returncode == 0, done.stderr
        return path

    return export
