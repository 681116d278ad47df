//! The runtime that every FMU carries, for the platform of this program and for others.

use std::fmt;
use std::str::FromStr;

use orthopanel_fmu::RESOURCE_SCHEMA;

use crate::{ExportError, FmiVersion};

/// The library, built with this crate.
pub(crate) const EMBEDDED: &[u8] = include_bytes!(env!("ORTHOPANEL_FMU_LIBRARY"));

/// Those of other platforms that the builder had made before, by their platform; one of this platform stands in place of its own, for
/// it runs on older systems.
const READY: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/ready.rs"));

/// Whether `content` is, byte for byte, a library that this version puts into FMUs: no stranger's code.
pub fn is_carried_library(content: &[u8]) -> bool {
    carried().any(|(_, carried)| carried == content)
}

/// The libraries that every FMU has unless others are given for their platforms.
fn carried() -> impl Iterator<Item = (Platform, &'static [u8])> {
    let ready = || READY.iter().filter_map(|(name, content)| Some((name.parse::<Platform>().ok()?, *content)));
    let own = Platform::here().filter(move |here| ready().all(|(platform, _)| platform != *here));
    own.into_iter().map(|here| (here, EMBEDDED)).chain(ready())
}

/// Operating system and processor that a library is for; as text FMI 3.0's `x86_64-linux`, or FMI 2.0's `linux64`,
/// `win64` and `darwin64`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Platform {
    architecture: &'static str,
    system: System,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum System {
    Linux,
    Windows,
    Darwin,
}

/// A platform with what FMI and a library's header call it.
struct KnownPlatform {
    platform: Platform,
    /// In FMI 2.0, where it has a name of its own there.
    fmi2: Option<&'static str>,
    /// What the header of a library calls its processor.
    machine: u32,
}

const fn known(architecture: &'static str, system: System, fmi2: Option<&'static str>, machine: u32) -> KnownPlatform {
    KnownPlatform { platform: Platform { architecture, system }, fmi2, machine }
}

const PLATFORMS: [KnownPlatform; 6] = [
    known("x86_64", System::Linux, Some("linux64"), 0x3e),
    known("aarch64", System::Linux, None, 0xb7),
    known("x86_64", System::Windows, Some("win64"), 0x8664),
    known("aarch64", System::Windows, None, 0xaa64),
    known("x86_64", System::Darwin, Some("darwin64"), 0x0100_0007),
    known("aarch64", System::Darwin, None, 0x0100_000c),
];

impl Platform {
    fn known(self) -> Option<&'static KnownPlatform> {
        PLATFORMS.iter().find(|known| known.platform == self)
    }

    /// The one that this program runs on; `None` where FMI has no name for it.
    pub(crate) fn here() -> Option<Self> {
        let system = if std::env::consts::OS == "macos" { "darwin" } else { std::env::consts::OS };
        format!("{}-{system}", std::env::consts::ARCH).parse().ok()
    }

    /// Place of its library inside the archive.
    pub(crate) fn path(self, version: FmiVersion, name: &str) -> String {
        let own = self.known().and_then(|known| known.fmi2);
        let folder = own.filter(|_| version == FmiVersion::Fmi2).map_or_else(|| self.to_string(), String::from);
        let extension = match self.system {
            System::Linux => "so",
            System::Windows => "dll",
            System::Darwin => "dylib",
        };
        format!("binaries/{folder}/{name}.{extension}")
    }
}

/// The processor in the header: ELF's `e_machine`, PE's `Machine` behind the address at 0x3c, Mach-O's `cputype`, all with the
/// lowest byte first. `None` where the file ends before.
fn machine(system: System, content: &[u8]) -> Option<u32> {
    let two = |at: usize| Some(u32::from(u16::from_le_bytes(content.get(at..at.checked_add(2)?)?.try_into().ok()?)));
    let four = |at: usize| Some(u32::from_le_bytes(content.get(at..at.checked_add(4)?)?.try_into().ok()?));
    match system {
        System::Linux => two(18),
        System::Windows => two(usize::try_from(four(0x3c)?).ok()?.checked_add(4)?),
        System::Darwin => four(4),
    }
}

impl fmt::Display for Platform {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let system = match self.system {
            System::Linux => "linux",
            System::Windows => "windows",
            System::Darwin => "darwin",
        };
        write!(f, "{}-{system}", self.architecture)
    }
}

impl FromStr for Platform {
    type Err = ExportError;

    fn from_str(text: &str) -> Result<Self, ExportError> {
        let found = PLATFORMS.iter().find(|known| known.platform.to_string() == text || known.fmi2 == Some(text));
        found.map(|known| known.platform).ok_or_else(|| ExportError::Platform {
            given: text.into(),
            known: PLATFORMS.iter().map(|known| known.platform.to_string()).collect::<Vec<_>>().join(", "),
        })
    }
}

/// The runtime of a platform, as built there from this version of `orthopanel-fmu`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Library {
    platform: Platform,
    content: Vec<u8>,
}

impl Library {
    /// # Errors
    /// [`ExportError::Library`] where `content` is no shared library of that system, or none of this version's runtime.
    pub fn new(platform: Platform, content: Vec<u8>) -> Result<Self, ExportError> {
        let (start, kind): (&[u8], _) = match platform.system {
            System::Linux => (b"\x7fELF", "an ELF shared object"),
            System::Windows => (b"MZ", "a DLL"),
            System::Darwin => (b"\xcf\xfa\xed\xfe", "a Mach-O library of one architecture"),
        };
        let refuse = |fault: String| {
            let reason = format!(
                "{fault}: build the crate orthopanel-fmu of this version for {platform} (its build-linux and build-windows do)"
            );
            Err(ExportError::Library { platform: platform.to_string(), reason })
        };
        if !content.starts_with(start) {
            return refuse(format!("it is not {kind}"));
        }
        let needed = platform.known().map(|known| known.machine);
        match (machine(platform.system, &content), needed) {
            (None, _) => return refuse("its header is cut off".into()),
            (Some(machine), Some(needed)) if machine != needed => {
                return refuse(format!(
                    "it is for another processor: its header has machine {machine:#x}, not {needed:#x}"
                ));
            }
            _ => {}
        }
        // What it reads is named in it: a runtime of another version would refuse this FMU's resource.
        for needed in ["fmi2Instantiate", "fmi3InstantiateCoSimulation", RESOURCE_SCHEMA] {
            if !content.windows(needed.len()).any(|window| window == needed.as_bytes()) {
                return refuse(format!("{needed:?} is not in it, so it is no orthopanel-fmu of this version"));
            }
        }
        Ok(Self { platform, content })
    }
}

/// Path and content of every library of an FMU of this name: those given, and those carried for platforms that none is given for.
///
/// # Errors
/// [`ExportError::Library`] where two are for one platform.
pub(crate) fn all(version: FmiVersion, name: &str, given: &[Library]) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    for (index, library) in given.iter().enumerate() {
        if given.iter().take(index).any(|before| before.platform == library.platform) {
            let reason = "it is given twice: leave one out".into();
            return Err(ExportError::Library { platform: library.platform.to_string(), reason });
        }
    }
    let own = carried().filter(|(platform, _)| given.iter().all(|library| library.platform != *platform));
    let own = own.map(|(platform, content)| (platform.path(version, name), content.to_vec()));
    let given = given.iter().map(|library| (library.platform.path(version, name), library.content.clone()));
    Ok(own.chain(given).collect())
}
