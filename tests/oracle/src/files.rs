//! Folders and files of a test, and what errors say of them.

use std::collections::BTreeMap;
use std::error::Error;
use std::fs;
use std::path::Path;

use tempfile::TempDir;

/// A new folder, which goes when the value does.
pub fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

/// The names of all files, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The files of a folder and their bytes.
pub type Files = BTreeMap<String, Vec<u8>>;

/// Reads all files.
pub fn files(folder: &Path) -> Files {
    names(folder).into_iter().map(|name| (name.clone(), fs::read(folder.join(name)).unwrap())).collect()
}

/// The message with all its causes.
#[must_use]
pub fn full_message(error: &dyn Error) -> String {
    match error.source() {
        Some(source) => format!("{error}: {}", full_message(source)),
        None => error.to_string(),
    }
}
