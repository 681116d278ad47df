"""FMUs of a wheel for every Linux run wherever the wheel does."""

import os
import re
import zipfile

import pytest
from conftest import EXAMPLES

import orthopanel as op

OLDEST = os.environ.get("ORTHOPANEL_OLDEST_GLIBC")


@pytest.mark.skipif(not OLDEST, reason="ORTHOPANEL_OLDEST_GLIBC is not set: python/run --zig sets it")
def test_its_fmus_ask_for_no_newer_c_library(tmp_path):
    op.Model.load(EXAMPLES / "plate.json").export(tmp_path / "plate.fmu")
    with zipfile.ZipFile(tmp_path / "plate.fmu") as archive:
        library = next(archive.read(name) for name in archive.namelist() if re.match("binaries/(linux64|x86_64-linux)/", name))
    asked = {tuple(map(int, version)) for version in re.findall(rb"GLIBC_(\d+)\.(\d+)", library)}
    assert asked and max(asked) <= tuple(map(int, OLDEST.split("."))), max(asked)
