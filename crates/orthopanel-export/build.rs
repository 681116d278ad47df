//! Builds the library that lies inside every FMU, so that this crate can embed it.
//!
//! A cdylib that is a plain dependency ends in `target/PROFILE/deps` and is lost by `cargo install`. So the library
//! is built here, in its own profile and target folder, and `src/library.rs` embeds its bytes. A release has it built before, for
//! older systems than the builder's own (`crates/orthopanel-fmu/build-linux`), and names it in [`READY`].
#![allow(clippy::print_stdout)]

use std::env;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Settings of the outer build that must not reach the inner one: clippy's wrapper, flags of one profile, coverage.
const LEAKING: [&str; 6] =
    ["RUSTFLAGS", "RUSTDOCFLAGS", "RUSTC_WORKSPACE_WRAPPER", "CLIPPY_ARGS", "RUSTC_BOOTSTRAP", "LLVM_PROFILE_FILE"];

/// `CARGO_...` settings of the user that the inner build needs too: where packages lie and how to fetch them.
const KEPT: [&str; 6] =
    ["CARGO_HOME", "CARGO_NET_", "CARGO_HTTP_", "CARGO_REGISTR", "CARGO_SOURCE_", "CARGO_MAKEFLAGS"];

/// Environment variable with the path of a library that is embedded in place of one built here; of one called [`NONE`] an empty one
/// is, for lints and documentation, which run nothing.
const READY: &str = "ORTHOPANEL_FMU_READY";

/// Named, so that a path that is mistyped stays an error.
const NONE: &str = "no-library";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo:rerun-if-env-changed={READY}");
    let crates = PathBuf::from(env::var("CARGO_MANIFEST_DIR")?).join("..");
    let runtime = crates.join("orthopanel-fmu");
    for source in [runtime.as_path(), &crates.join("orthopanel-model")] {
        println!("cargo:rerun-if-changed={}", source.join("src").display());
        println!("cargo:rerun-if-changed={}", source.join("Cargo.toml").display());
    }
    println!("cargo:rerun-if-changed=build.rs");
    let workspace = crates.join("..");
    // What is not there counts as changed at every build: of a published crate no workspace is watched.
    let is_workspace = workspace.join("Cargo.lock").exists();
    for workspace_file in ["Cargo.toml", "Cargo.lock"].iter().filter(|_| is_workspace) {
        println!("cargo:rerun-if-changed={}", workspace.join(workspace_file).display());
    }

    let library = match env::var_os(READY) {
        Some(ready) if Path::new(&ready).file_name().is_some_and(|name| name == NONE) => {
            let empty = PathBuf::from(env::var("OUT_DIR")?).join(NONE);
            std::fs::write(&empty, "")?;
            empty
        }
        Some(ready) => existing(Path::new(&ready))?,
        None => build(&runtime.join("Cargo.toml"))?,
    };
    println!("cargo:rustc-env=ORTHOPANEL_FMU_LIBRARY={}", library.display());
    let others = workspace.join("target/fmu-libraries");
    // An empty one is put there to be watched, older than this build.
    if is_workspace && !others.exists() && std::fs::create_dir_all(&others).is_ok() {
        let folder = std::fs::File::open(&others);
        folder.and_then(|folder| folder.set_modified(std::time::SystemTime::UNIX_EPOCH)).ok();
    }
    ready_for_others(&others, &crates)
}

/// Names the libraries that `build-linux` and `build-windows` left in a folder, so that they are embedded beside this platform's own. One
/// that is older than a source is left out: an FMU whose platforms differ would be worse than one of fewer.
fn ready_for_others(folder: &Path, crates: &Path) -> Result<(), Box<dyn Error>> {
    if folder.exists() {
        println!("cargo:rerun-if-changed={}", folder.display());
    }
    let newest = ["orthopanel-fmu/src", "orthopanel-model/src"].map(|source| newest(&crates.join(source)));
    let newest = newest.into_iter().collect::<Result<Vec<_>, _>>()?.into_iter().max();
    let mut list = String::from("&[");
    for file in std::fs::read_dir(folder).into_iter().flatten() {
        let file = file?;
        println!("cargo:rerun-if-changed={}", file.path().display());
        if Some(file.metadata()?.modified()?) < newest {
            println!(
                "cargo:warning={}: older than its sources, so FMUs go without it: build it again",
                file.path().display()
            );
            continue;
        }
        let (name, path) = (file.file_name(), file.path().canonicalize()?);
        let name = name.to_str().ok_or("a file in target/fmu-libraries has no name in UTF-8")?;
        list += &format!(
            "({name:?}, include_bytes!({:?})),",
            path.to_str().ok_or("the target folder has no name in UTF-8")?
        );
    }
    std::fs::write(PathBuf::from(env::var("OUT_DIR")?).join("ready.rs"), list + "]")?;
    Ok(())
}

/// When the youngest file below a folder was changed.
fn newest(folder: &Path) -> Result<std::time::SystemTime, Box<dyn Error>> {
    let mut newest = std::time::SystemTime::UNIX_EPOCH;
    for entry in std::fs::read_dir(folder)? {
        let entry = entry?;
        let of_entry =
            if entry.file_type()?.is_dir() { self::newest(&entry.path())? } else { entry.metadata()?.modified()? };
        newest = newest.max(of_entry);
    }
    Ok(newest)
}

/// The whole path of a library that was built before.
fn existing(ready: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let whole = ready
        .canonicalize()
        .map_err(|error| format!("{READY} = {}: {error}; give the whole path of the FMU's library", ready.display()))?;
    println!("cargo:rerun-if-changed={}", whole.display());
    Ok(whole)
}

/// Flags that put names in place of this machine's folders: every FMU carries the library to strangers, and one version of it is
/// the same bytes wherever it is built. The later of two that fit a path counts.
fn without_paths(manifest: &Path, target_folder: &Path) -> Result<Vec<String>, Box<dyn Error>> {
    let rustc = env::var_os("RUSTC").ok_or("cargo names no compiler in RUSTC")?;
    let told = |arguments: &[&str]| -> Result<String, Box<dyn Error>> {
        Ok(String::from_utf8(Command::new(&rustc).args(arguments).output()?.stdout)?)
    };
    let version = told(&["--version", "--verbose"])?;
    let commit = version.lines().find_map(|line| line.strip_prefix("commit-hash: ")).unwrap_or("unknown");
    let sysroot = PathBuf::from(told(&["--print", "sysroot"])?.trim_end());
    let workspace = manifest.canonicalize()?.ancestors().nth(3).map(Path::to_path_buf).unwrap_or_default();
    let mut folders = vec![
        (workspace, "orthopanel".into()),
        (target_folder.to_path_buf(), "target".into()),
        (sysroot.join("lib/rustlib/src/rust"), format!("/rustc/{commit}")),
    ];
    let home = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(env::home_dir()?.join(".cargo")));
    if let Some(home) = home {
        folders.push((home.clone(), "cargo".into()));
        // Below it is a folder for each registry or mirror of one.
        let sources = home.join("registry/src");
        let registries = std::fs::read_dir(sources).into_iter().flatten().flatten();
        folders.extend(registries.map(|registry| (registry.path(), "crates".into())));
    }
    Ok(folders.iter().map(|(from, to)| format!("--remap-path-prefix={}={to}", from.display())).collect())
}

/// Builds the library in the profile `fmu`; returns where it lies.
fn build(manifest: &Path) -> Result<PathBuf, Box<dyn Error>> {
    let target_folder = PathBuf::from(env::var("OUT_DIR")?).join("fmu");
    let (target, host) = (env::var("TARGET")?, env::var("HOST")?);
    let mut cargo = Command::new(env::var("CARGO")?);
    for (name, _) in env::vars_os() {
        let text = name.to_string_lossy();
        let cargos = text.starts_with("CARGO") && !KEPT.iter().any(|kept| text.starts_with(kept));
        if cargos || LEAKING.contains(&text.as_ref()) {
            cargo.env_remove(&name);
        }
    }
    // The cdylib alone: of this and the rlib together none is optimised across crates.
    cargo.args(["rustc", "--quiet", "--lib", "--profile", "fmu", "--features", "compact", "--crate-type", "cdylib"]);
    cargo.arg("--manifest-path").arg(manifest).arg("--target-dir").arg(&target_folder);
    cargo.env("CARGO_ENCODED_RUSTFLAGS", without_paths(manifest, &target_folder)?.join("\u{1f}"));
    let mut folder = target_folder;
    if target != host {
        cargo.args(["--target", &target]);
        folder.push(&target);
    }
    let status = cargo.status()?;
    if !status.success() {
        return Err(format!("building the FMU's library failed ({status}): its messages stand above").into());
    }
    let name = match env::var("CARGO_CFG_TARGET_OS")?.as_str() {
        "windows" => "orthopanel_fmu.dll",
        "macos" => "liborthopanel_fmu.dylib",
        _ => "liborthopanel_fmu.so",
    };
    Ok(folder.join("fmu").join(name))
}
