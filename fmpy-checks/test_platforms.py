"""Which platforms an FMU of this build loads on: those named in ORTHOPANEL_PLATFORMS, as .ci/platforms builds them."""

import os
import re
import zipfile

import pytest

# Folder in FMI 2.0 and what the header calls the processor: ELF's e_machine, PE's Machine.
PLATFORMS = {
    "x86_64-linux": ("linux64", 0x3E),
    "aarch64-linux": ("aarch64-linux", 0xB7),
    "x86_64-windows": ("win64", 0x8664),
}
LIMIT = 1_500_000


def two_bytes(content, at):
    return int.from_bytes(content[at : at + 2], "little")


@pytest.mark.parametrize("version", [2, 3])
def test_an_fmu_carries_every_platform_that_was_built(export, version):
    asked = os.environ.get("ORTHOPANEL_PLATFORMS", "").split()
    if not asked:
        pytest.skip("ORTHOPANEL_PLATFORMS names no platform: .ci/platforms builds them")
    fmu = export(f"platforms-{version}.fmu", "--fmi", str(version), "--name", "floor")
    with zipfile.ZipFile(fmu) as archive:
        for platform in asked:
            folder, machine = PLATFORMS[platform]
            is_windows = platform.endswith("windows")
            library = f"binaries/{folder if version == 2 else platform}/floor.{'dll' if is_windows else 'so'}"
            content = archive.read(library)
            assert len(content) < LIMIT, (platform, len(content))
            if is_windows:
                assert two_bytes(content, two_bytes(content, 0x3C) + 4) == machine
            else:
                newest = max(int(minor) for minor in re.findall(rb"GLIBC_2\.(\d+)", content))
                assert two_bytes(content, 18) == machine and newest <= 17, (platform, newest)
