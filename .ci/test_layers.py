"""Circles between files are found, and what is none is not taken for one."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import layers


def printed(files):
    """What the check prints of a crate of these files."""
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()) as out:
        for name, text in files.items():
            file = Path(folder, "src", name)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        count = layers.check(Path(folder))
    return count, out.getvalue()


class Circles(unittest.TestCase):
    def found(self, count, files, *said):
        number, text = printed(files)
        self.assertEqual(number, count, text)
        for words in said:
            self.assertIn(words, text)

    def test_by_use_and_by_path(self):
        beam = "use crate::plate::Plate;\npub struct Beam(Plate);"
        plate = "pub struct Plate;\nfn f() { crate::beam::Beam::new() }"
        files = {"lib.rs": "mod beam;\nmod plate;", "beam.rs": beam, "plate.rs": plate}
        self.found(1, files, "beam -> plate: plate::Plate", "plate -> beam: beam::Beam::new")

    def test_through_reexports_of_whole_modules(self):
        lib = "mod a;\npub mod b;\npub use b::*;"
        files = {
            "lib.rs": lib,
            "a.rs": "use crate::{Mode as Shape, b};\npub fn a() -> Shape { b::c::deep() }",
            "b/mod.rs": "pub mod c;\npub use c::Mode;",
            "b/c.rs": "pub struct Mode;\npub fn deep() { super::super::a::a() }",
        }
        self.found(1, files, "a -> b::c: Mode, b::c::deep", "b::c -> a: a::a")

    def test_of_a_module_and_its_child(self):
        files = {
            "lib.rs": "mod law;",
            "law.rs": "mod core;\nuse self::core::shear;\npub struct Law;\nfn f() { shear() }",
            "law/core.rs": "use super::Law;\npub fn shear() {}",
        }
        self.found(1, files, "law -> law::core: core::shear", "law::core -> law: Law")

    def test_declarations_reexports_tests_comments_and_other_crates_make_none(self):
        files = {
            "lib.rs": "mod law;\nmod name;\npub use law::{Law, name};",
            "law.rs": "mod core;\npub use self::core::shear;\npub use crate::name::name;\npub struct Law { name: u8 }\n"
            "// use self::core::shear;\nconst TEXT: &str = \"crate::name::name()\";\n"
            "#[cfg(test)]\nmod tests {\n    fn f() { crate::name::written() }\n}",
            "law/core.rs": "use std::fmt;\nuse super::Law;\npub(in crate::law) fn shear() {}",
            "name.rs": "use crate::law::Law;\npub fn name(_: Law) {}\npub fn written() {}",
        }
        self.found(0, files)


if __name__ == "__main__":
    unittest.main()
