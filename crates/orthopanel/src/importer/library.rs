//! The library inside an FMU: which one may be loaded, and whether it is whole.

use std::path::Path;

use object::{FileKind, Object as _, ObjectSegment as _};
use tempfile::TempDir;

use super::archive::{Archive, place};
use crate::fmu_refusal::{FmuRefusal, shown};

/// The folder of the archive that every library may read from.
const RESOURCES: &str = "resources/";

/// Unpacks the library at `path` and what it needs into a folder of its own.
///
/// A library that this program carries needs nothing beside it: what else lies there could be loaded in place of a system's
/// library of that name. Any other is unpacked only where the user trusts it.
pub(super) fn unpack(archive: &mut Archive, path: &str, trust: bool) -> Result<TempDir, FmuRefusal> {
    let Some(content) = archive.take(path, u64::MAX)? else {
        let others = archive.names().filter(|name| is_library(name)).map(shown).take(6).collect();
        return Err(FmuRefusal::NoLibrary { path: path.into(), others });
    };
    let carried = orthopanel_export::is_carried_library(&content);
    if !carried {
        if !trust {
            return Err(FmuRefusal::Untrusted { path: path.into(), size: content.len() });
        }
        whole(&content).map_err(|reason| FmuRefusal::DamagedLibrary { path: path.into(), reason })?;
    }
    let home = std::env::temp_dir();
    let folder = tempfile::Builder::new().prefix("orthopanel-").tempdir_in(&home);
    let folder = folder.map_err(|source| FmuRefusal::Unpack { what: "written into", path: home, source })?;
    place(folder.path(), path, &content)?;
    let beside = Path::new(path).parent().filter(|_| !carried);
    archive.unpack(folder.path(), |name| {
        let beside = beside.is_some_and(|beside| Path::new(name).starts_with(beside));
        name != path && (beside || name.starts_with(RESOURCES))
    })?;
    Ok(folder)
}

fn is_library(name: &str) -> bool {
    name.starts_with("binaries/") && [".so", ".dll", ".dylib"].iter().any(|extension| name.ends_with(extension))
}

/// Whether all that the headers tell the loader to map lies inside the file: where it does not, the first touch of a page kills
/// the process. Mach-O files of several architectures are left to their loader, which looks itself.
fn whole(content: &[u8]) -> Result<(), String> {
    if matches!(FileKind::parse(content), Ok(FileKind::MachOFat32 | FileKind::MachOFat64)) {
        return Ok(());
    }
    let file = object::File::parse(content).map_err(|error| error.to_string())?;
    file.segments().try_for_each(|segment| segment.data().map(drop)).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use std::fs::File;
    use std::io::{Cursor, Write as _};

    use orthopanel_export::{Fmu, FmuOptions};
    use orthopanel_model::{ModalModel, Mode, Place, Ports};
    use zip::ZipWriter;
    use zip::write::SimpleFileOptions;

    use super::*;

    /// The library that this program carries.
    fn carried() -> Vec<u8> {
        let mode =
            Mode { angular_frequency: 2000.0, damping_ratio: 0.01, at_forces: vec![1.0], at_responses: vec![1.0] };
        let model = ModalModel::new(1, 1, vec![mode]).expect("a model");
        let places = vec![Place { x: 0.0, y: 0.0 }];
        let fmu = Fmu::new(model, Ports { forces: places.clone(), responses: places }, &FmuOptions::default());
        let packed = fmu.and_then(|fmu| fmu.to_bytes()).expect("an FMU");
        let mut archive = Archive::new(&packed[..]).expect("an archive");
        let path = archive.names().find(|name| is_library(name)).expect("a library").to_owned();
        archive.take(&path, u64::MAX).expect("unpacked").expect("there")
    }

    /// Which of its files an archive with this library at `binaries/here/x.so` unpacks.
    fn unpacked(library: &[u8], trust: bool) -> Result<Vec<&'static str>, FmuRefusal> {
        let files = ["binaries/here/x.so", "binaries/here/libc.so.6", "binaries/there/x.so", "resources/a/b", "other"];
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for name in files {
            writer.start_file(name, SimpleFileOptions::default()).expect("an entry");
            writer.write_all(if name == files[0] { library } else { b"x" }).expect("written");
        }
        let packed = writer.finish().expect("written").into_inner();
        let folder = unpack(&mut Archive::new(&packed[..])?, files[0], trust)?;
        Ok(files.into_iter().filter(|name| File::open(folder.path().join(name)).is_ok()).collect())
    }

    #[test]
    fn beside_the_carried_library_nothing_else_can_be_loaded() {
        let mut library = carried();
        for trust in [false, true] {
            assert_eq!(unpacked(&library, trust).expect("whole"), ["binaries/here/x.so", "resources/a/b"]);
        }
        library.push(0);
        assert!(matches!(unpacked(&library, false), Err(FmuRefusal::Untrusted { .. })));
        let files = ["binaries/here/x.so", "binaries/here/libc.so.6", "resources/a/b"];
        assert_eq!(unpacked(&library, true).expect("whole"), files);
    }
}
