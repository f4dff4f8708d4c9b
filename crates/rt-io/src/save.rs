//! Saving a file so that nothing, be it a killed process or a full disk, leaves half of it.
//!
//! The bytes go to a temporary file beside the target, reach the disk, and take the target's place in one step, a
//! rename within one folder. A temporary is called `.NAME.ID.tmp` and is locked by the process that writes it. When
//! that process dies, the lock goes with it; the next save of the same target finds the temporary unlocked and removes
//! it. The lock, unlike a process number in the name, also tells live writers from dead ones between machines that
//! share a folder. On a file system without locks, what a dead process left stays.
//!
//! A temporary that will replace a file can be read by its writer alone until its bytes are there; then it gets the old
//! file's owner and group, and last its mode, because a change of owner clears the setuid and setgid bits. A process
//! without the right to give a file away keeps the group if it is a member of it. What the mode would then grant to the
//! wrong ones is taken out: to run as the new owner or group, and to the new group whatever was not granted to
//! everybody.

use std::error::Error;
use std::fmt;
#[cfg(unix)]
use std::fs::Permissions;
use std::fs::{self, File, Metadata, OpenOptions, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{self, Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

/// Why a file was not saved. An existing file is as it was before.
#[derive(Debug)]
#[expect(missing_docs, reason = "the messages say what the fields are")]
#[non_exhaustive]
pub enum SaveError {
    /// The path names a folder.
    Folder { path: PathBuf },
    /// The folder of the file does not exist.
    MissingFolder { path: PathBuf, folder: PathBuf },
    /// The place cannot be written to: no permission, a read-only file or folder, a circle of links.
    Open { path: PathBuf, source: io::Error },
    /// Writing failed on the way: a full disk, a closed pipe, or an error of the writing closure itself.
    Write { path: PathBuf, source: io::Error },
}

impl fmt::Display for SaveError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Folder { path } => write!(f, "{} is a folder, not a file", path.display()),
            Self::MissingFolder { path, folder } => {
                write!(f, "{}: the folder {} does not exist; create it first", path.display(), folder.display())
            }
            Self::Open { path, .. } => write!(f, "{}: cannot be written", path.display()),
            Self::Write { path, .. } => write!(f, "{}: writing failed", path.display()),
        }
    }
}

impl Error for SaveError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        match self {
            Self::Open { source, .. } | Self::Write { source, .. } => Some(source),
            Self::Folder { .. } | Self::MissingFolder { .. } => None,
        }
    }
}

/// Writes the file at `path` by `write`, whole or not at all.
///
/// Until the last moment an existing file stays untouched. The new one keeps its mode, and its owner and group where
/// the process may give files away; where it may not, the mode never grants more than it did (see below). A file that
/// was not there gets the mode of any newly created file. A symbolic link is followed, and its target replaced. What is
/// not a regular file (a pipe, `/dev/stdout`, `/dev/full`) is written directly.
///
/// It is another file that takes the name: hard links to the old one keep the old bytes, and access lists, extended
/// attributes and the time of creation are lost. Where a file had an access list, the bits of its mode for the group
/// are the most that the list granted to anybody, and the group then has them.
///
/// Where the owner cannot be kept, no program is left that runs as its owner; where the group cannot be, none that runs
/// as its group, and the new group may do only what everybody may.
///
/// A process killed inside leaves a temporary file, which the next save of the same path removes. `write` gets a
/// buffered writer, and need not flush it.
///
/// # Errors
/// [`SaveError`] names the path and the cause; no temporary file is left.
///
/// ```
/// # fn main() -> Result<(), rt_io::SaveError> {
/// let path = std::env::temp_dir().join("rt-io-save-example.txt");
/// rt_io::save_atomically(&path, |out| out.write_all(b"all of it"))?;
/// assert_eq!(std::fs::read(&path).unwrap(), b"all of it");
/// # std::fs::remove_file(&path).unwrap();
/// # Ok(())
/// # }
/// ```
pub fn save_atomically(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), SaveError> {
    let open_error = |source| SaveError::Open { path: path.to_path_buf(), source };
    let write_error = |source| SaveError::Write { path: path.to_path_buf(), source };
    if path.as_os_str().is_empty() {
        return Err(open_error(io::Error::other("an empty path names no file")));
    }
    if path.to_string_lossy().ends_with(path::is_separator) {
        return Err(SaveError::Folder { path: path.to_path_buf() });
    }

    let (target, old) = match resolve(path).map_err(open_error)? {
        Target::Folder => return Err(SaveError::Folder { path: path.to_path_buf() }),
        Target::Device(device) => {
            // Appending, so that `>> file` behind /dev/stdout keeps what it holds; for a pipe it makes no difference.
            let mut file = OpenOptions::new().append(true).open(device).map_err(open_error)?;
            return write_all(&mut file, write).map_err(write_error);
        }
        Target::New(target) => (target, None),
        Target::File(target) => {
            // A rename would ask the folder alone; a file that may not be written is not replaced either.
            let file = OpenOptions::new().write(true).open(&target).map_err(open_error)?;
            (target, Some(file.metadata().map_err(open_error)?))
        }
    };

    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let name = temporary_name(&target);
    remove_stale(folder, &name);
    let mut temporary = Temporary::create(folder, &name, old.is_some()).map_err(|source| {
        if source.kind() == io::ErrorKind::NotFound && !folder.is_dir() {
            SaveError::MissingFolder { path: path.to_path_buf(), folder: folder.to_path_buf() }
        } else {
            open_error(source)
        }
    })?;
    write_all(&mut temporary.file, write).map_err(write_error)?;
    if let Some(old) = old {
        keep_access(&temporary.file, &old).map_err(write_error)?;
    }
    temporary.file.sync_all().map_err(write_error)?;
    fs::rename(&temporary.path, &target).map_err(write_error)?;
    temporary.renamed = true;
    Ok(())
}

fn write_all(file: &mut File, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 16, file);
    match write(&mut out) {
        Ok(()) => out.flush(),
        Err(error) => {
            // Nothing more is to be written, not even by the drop of the buffer.
            drop(out.into_parts());
            Err(error)
        }
    }
}

/// Gives a file that replaces another its owner, group and mode, as far as that is allowed.
#[cfg(unix)]
fn keep_access(file: &File, old: &Metadata) -> io::Result<()> {
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};

    let new = file.metadata()?;
    if (new.uid(), new.gid()) != (old.uid(), old.gid())
        && fchown(file, Some(old.uid()), Some(old.gid())).is_err()
        && new.gid() != old.gid()
    {
        // Whether it could is seen below.
        let _ = fchown(file, None, Some(old.gid()));
    }
    let new = file.metadata()?;
    let mode = safe_mode(old.mode() & 0o7777, new.uid() == old.uid(), new.gid() == old.gid());
    if new.mode() & 0o7777 != mode {
        file.set_permissions(Permissions::from_mode(mode))?;
    }
    Ok(())
}

/// The mode without what it would grant to others, if the owner or the group has changed.
#[cfg(unix)]
fn safe_mode(mode: u32, owner_kept: bool, group_kept: bool) -> u32 {
    let mut mode = mode;
    if !owner_kept {
        mode &= !0o4000;
    }
    if !group_kept {
        let everybody = mode & 0o007;
        mode &= !0o2070 | everybody << 3;
    }
    mode
}

/// Gives a file that replaces another its permissions.
#[cfg(not(unix))]
fn keep_access(file: &File, old: &Metadata) -> io::Result<()> {
    if file.metadata()?.permissions() != old.permissions() {
        file.set_permissions(old.permissions())?;
    }
    Ok(())
}

/// What stands at the end of a path's links.
enum Target {
    /// A regular file.
    File(PathBuf),
    /// Nothing yet.
    New(PathBuf),
    /// Anything that is written to and not replaced.
    Device(PathBuf),
    Folder,
}

/// As many links as Linux follows.
const MOST_LINKS: usize = 40;

fn resolve(path: &Path) -> io::Result<Target> {
    let mut path = path.to_path_buf();
    for _ in 0..=MOST_LINKS {
        // An open file of a process, such as /dev/stdout: even if it is a regular one, others hold it open.
        if path.starts_with("/proc") || path.starts_with("/dev/fd") {
            return Ok(Target::Device(path));
        }
        let metadata = match fs::symlink_metadata(&path) {
            Ok(metadata) => metadata,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(Target::New(path)),
            Err(error) => return Err(error),
        };
        if metadata.is_file() {
            return Ok(Target::File(path));
        } else if metadata.is_dir() {
            return Ok(Target::Folder);
        } else if !metadata.is_symlink() {
            return Ok(Target::Device(path));
        }
        let link = fs::read_link(&path)?;
        path.pop();
        path.push(link);
    }
    Err(io::Error::other("too many symbolic links"))
}

/// What all temporaries of `target` begin with. Two targets may share it, at worst one removes the other's stale ones.
fn temporary_name(target: &Path) -> String {
    let name = target.file_name().unwrap_or_default().to_string_lossy();
    // A file name is at most 255 bytes nearly everywhere; the rest of ours takes under 30.
    let mut length = name.len().min(200);
    while !name.is_char_boundary(length) {
        length -= 1;
    }
    format!(".{}.", &name[..length])
}

/// Removes the temporaries that begin with `name` and that no living process holds. A failure here does not prevent
/// saving.
fn remove_stale(folder: &Path, name: &str) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let is_temporary = entry.file_name().to_str().is_some_and(|found| {
            found.strip_prefix(name).and_then(|rest| rest.strip_suffix(".tmp")).is_some_and(is_id)
        });
        if is_temporary
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && let Ok(file) = OpenOptions::new().write(true).open(entry.path())
            && file.try_lock().is_ok()
        {
            let _ = fs::remove_file(entry.path());
        }
    }
}

fn id(number: u32) -> String {
    format!("{:08x}{number:08x}", std::process::id())
}

fn is_id(text: &str) -> bool {
    text.len() == 16 && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// A locked temporary file, removed when dropped unless it was renamed.
struct Temporary {
    path: PathBuf,
    file: File,
    renamed: bool,
}

impl Temporary {
    /// Creates a file with the mode of any new one, or for its owner alone.
    fn create(folder: &Path, name: &str, private: bool) -> io::Result<Self> {
        static NEXT: AtomicU32 = AtomicU32::new(0);
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        if private {
            std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        }
        #[cfg(not(unix))]
        let _ = private;
        loop {
            let path = folder.join(format!("{name}{}.tmp", id(NEXT.fetch_add(1, Ordering::Relaxed))));
            let file = match options.open(&path) {
                Ok(file) => file,
                // Another machine's process of the same number, or a stale one that could not be removed.
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                Err(error) => return Err(error),
            };
            if let Some(temporary) = Self::claim(path, file) {
                return Ok(temporary);
            }
        }
    }

    /// Locks a file that was just created, or gives it up to a clean-up that found it before it was locked.
    fn claim(path: PathBuf, file: File) -> Option<Self> {
        match file.try_lock() {
            // Nobody removes a locked file; a clean-up may have removed it before.
            Ok(()) if path.exists() => {}
            Ok(()) => return None,
            // A clean-up is about to remove it.
            Err(TryLockError::WouldBlock) => return None,
            // A file system without locks: no clean-up can lock the file either, so none removes it.
            Err(TryLockError::Error(_)) => {}
        }
        Some(Self { path, file, renamed: false })
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        if !self.renamed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn a_mode_grants_no_more_to_another_owner_or_group() {
        for mode in 0..=0o7777 {
            assert_eq!(safe_mode(mode, true, true), mode);
            assert_eq!(safe_mode(mode, false, true), mode & 0o3777, "{mode:o}");
            let other_group = safe_mode(mode, true, false);
            assert_eq!(other_group & 0o5707, mode & 0o5707, "{mode:o}: what is not the group's stays");
            assert_eq!(other_group & 0o2000, 0, "{mode:o}");
            assert_eq!(other_group >> 3 & 7, (mode >> 3) & mode & 7, "{mode:o}");
        }
    }

    #[test]
    fn a_temporary_that_a_clean_up_found_first_is_given_up() {
        let folder = std::env::temp_dir().join(format!("rt-io-claim-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join(format!(".a.{}.tmp", id(0)));

        // Locked by the clean-up, then removed by it, before the writer locks.
        let file = File::create_new(&path).unwrap();
        let clean_up = OpenOptions::new().write(true).open(&path).unwrap();
        clean_up.lock().unwrap();
        assert!(Temporary::claim(path.clone(), file).is_none());
        drop(clean_up);
        fs::remove_file(&path).unwrap();
        let file = File::create_new(&path).unwrap();
        remove_stale(&folder, ".a.");
        assert!(Temporary::claim(path.clone(), file).is_none());

        // Locked by the writer first: nobody removes it but the writer.
        let temporary = Temporary::claim(path.clone(), File::create_new(&path).unwrap()).unwrap();
        remove_stale(&folder, ".a.");
        assert!(path.exists());
        drop(temporary);
        assert!(!path.exists());
        fs::remove_dir(&folder).unwrap();
    }
}
