//! The runtime that every FMU carries, for the platform of this program and for others.

use std::fmt;
use std::str::FromStr;

use orthopanel_fmu::{MODEL_IDENTIFIER, RESOURCE_SCHEMA};

use crate::{ExportError, FmiVersion};

/// The library, built with this crate.
pub(crate) const EMBEDDED: &[u8] = include_bytes!(env!("ORTHOPANEL_FMU_LIBRARY"));

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

/// Every platform: its name in FMI 3.0, and the one of its own that FMI 2.0 may have for it.
const PLATFORMS: [(&str, &str, System, Option<&str>); 6] = [
    ("x86_64-linux", "x86_64", System::Linux, Some("linux64")),
    ("aarch64-linux", "aarch64", System::Linux, None),
    ("x86_64-windows", "x86_64", System::Windows, Some("win64")),
    ("aarch64-windows", "aarch64", System::Windows, None),
    ("x86_64-darwin", "x86_64", System::Darwin, Some("darwin64")),
    ("aarch64-darwin", "aarch64", System::Darwin, None),
];

impl Platform {
    /// The one that this program runs on; `None` where FMI has no name for it.
    pub(crate) fn here() -> Option<Self> {
        let system = if std::env::consts::OS == "macos" { "darwin" } else { std::env::consts::OS };
        format!("{}-{system}", std::env::consts::ARCH).parse().ok()
    }

    /// Place of its library inside the archive.
    pub(crate) fn path(self, version: FmiVersion) -> String {
        let own = PLATFORMS.iter().find(|(name, ..)| *name == self.to_string()).and_then(|(.., own)| *own);
        let folder = own.filter(|_| version == FmiVersion::Fmi2).map_or_else(|| self.to_string(), String::from);
        let extension = match self.system {
            System::Linux => "so",
            System::Windows => "dll",
            System::Darwin => "dylib",
        };
        format!("binaries/{folder}/{MODEL_IDENTIFIER}.{extension}")
    }
}

impl Platform {
    /// What the header of a library calls its processor.
    fn machine(self) -> u32 {
        match (self.system, self.architecture == "aarch64") {
            (System::Linux, false) => 0x3e,
            (System::Linux, true) => 0xb7,
            (System::Windows, false) => 0x8664,
            (System::Windows, true) => 0xaa64,
            (System::Darwin, false) => 0x0100_0007,
            (System::Darwin, true) => 0x0100_000c,
        }
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
        let found = PLATFORMS.iter().find(|(name, _, _, own)| *name == text || *own == Some(text));
        found.map(|&(_, architecture, system, _)| Self { architecture, system }).ok_or_else(|| ExportError::Platform {
            given: text.into(),
            known: PLATFORMS.map(|(name, ..)| name).join(", "),
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
        let refuse = |reason| Err(ExportError::Library { platform: platform.to_string(), reason });
        if !content.starts_with(start) {
            return refuse(format!("it is not {kind}"));
        }
        match machine(platform.system, &content) {
            Some(machine) if machine == platform.machine() => {}
            Some(machine) => {
                let needed = platform.machine();
                return refuse(format!(
                    "it is for another processor: its header has machine {machine:#x}, not {needed:#x}"
                ));
            }
            None => return refuse("its header is cut off".into()),
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

/// Path and content of every library of an FMU: those given, and the one of this platform where none is given for it.
///
/// # Errors
/// [`ExportError::Library`] where two are for one platform.
pub(crate) fn all(version: FmiVersion, given: &[Library]) -> Result<Vec<(String, Vec<u8>)>, ExportError> {
    for (index, library) in given.iter().enumerate() {
        if given.iter().take(index).any(|before| before.platform == library.platform) {
            let reason = "it is given twice".into();
            return Err(ExportError::Library { platform: library.platform.to_string(), reason });
        }
    }
    let here = Platform::here().filter(|here| given.iter().all(|library| library.platform != *here));
    let embedded = here.map(|here| (here.path(version), EMBEDDED.to_vec()));
    let given = given.iter().map(|library| (library.platform.path(version), library.content.clone()));
    Ok(embedded.into_iter().chain(given).collect())
}
