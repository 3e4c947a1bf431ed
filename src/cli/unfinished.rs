//! What a run has begun and not finished: new files that have no name yet, and new directories. A
//! signal that ends the process removes them first.

use super::embedded::is_embedded;
use std::fs::{self, Permissions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, Once, PoisonError};
use tempfile::NamedTempFile;

/// Paths of a run. What was finished stays listed: its first name is nobody's, and a directory with
/// something in it is not removed.
struct Begun {
    files: Vec<PathBuf>,
    /// The deepest first.
    directories: Vec<PathBuf>,
}

static BEGUN: Mutex<Begun> = Mutex::new(Begun { files: Vec::new(), directories: Vec::new() });

/// Who holds this makes or names files; a signal waits for it.
fn begun() -> MutexGuard<'static, Begun> {
    BEGUN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A new file in a directory, of a name that nobody knows before: what a killed run left behind is
/// in nobody's way.
pub(super) fn new_file(directory: &Path) -> io::Result<NamedTempFile> {
    watch_signals();
    let mut builder = tempfile::Builder::new();
    builder.prefix(".denavit-").suffix(".tmp");
    if let Some(permissions) = usual_permissions() {
        builder.permissions(permissions);
    }
    let mut begun = begun();
    let file = builder.tempfile_in(directory)?;
    begun.files.push(file.path().to_owned());
    Ok(file)
}

/// Gives files their names, all of them before a signal ends the process. The error has the place
/// of its file in the list.
pub(super) fn name(files: Vec<(NamedTempFile, PathBuf)>) -> Result<(), (usize, io::Error)> {
    let _held = begun();
    for (place, (file, path)) in files.into_iter().enumerate() {
        file.persist(path).map_err(|error| (place, error.error))?;
    }
    Ok(())
}

/// Makes a directory with those above it; gives those that are new, the deepest first.
pub(super) fn new_directories(path: &Path) -> io::Result<Vec<PathBuf>> {
    watch_signals();
    let mut begun = begun();
    let is_new = |one: &&Path| !one.as_os_str().is_empty() && !one.exists();
    let made: Vec<PathBuf> = path.ancestors().take_while(is_new).map(Path::to_owned).collect();
    begun.directories.splice(0..0, made.iter().cloned());
    fs::create_dir_all(path)?;
    Ok(made)
}

/// Those of a file that is simply made: temporary files are their owner's alone.
#[cfg(unix)]
fn usual_permissions() -> Option<Permissions> {
    use std::os::unix::fs::PermissionsExt;
    Some(Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn usual_permissions() -> Option<Permissions> {
    None
}

fn watch_signals() {
    if is_embedded() {
        // they are the program's, and may not end it
        return;
    }
    static WATCHED: Once = Once::new();
    WATCHED.call_once(|| {
        #[cfg(unix)]
        signals::watch();
    });
}

#[cfg(unix)]
mod signals {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::sync::mpsc;
    use std::{fs, process, thread};

    /// Waits for a signal in a thread of its own. Where there is none, signals end the process as
    /// ever.
    pub(super) fn watch() {
        let (ready, is_ready) = mpsc::channel();
        let waiting = thread::Builder::new().name("signals".to_owned()).spawn(move || {
            let Ok(mut signals) = Signals::new(heeded()) else { return };
            let _ = ready.send(());
            if let Some(signal) = signals.forever().next() {
                end(signal);
            }
        });
        if waiting.is_ok() {
            // an error says that the thread has ended
            let _ = is_ready.recv();
        }
    }

    /// Signals that end the process. One that was ignored from the start (nohup, or an interrupt
    /// of a job in the background) stays ignored; of the system that does not say so, a hangup.
    fn heeded() -> Vec<i32> {
        let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        match line.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()) {
            Some(ignored) => {
                let is_heeded = |signal: &i32| ignored & (1 << (signal - 1)) == 0;
                [SIGINT, SIGTERM, SIGHUP].into_iter().filter(is_heeded).collect()
            }
            None => vec![SIGINT, SIGTERM],
        }
    }

    /// Ends the process as the signal would have, so that a shell sees 128 and its number.
    fn end(signal: i32) {
        let begun = super::begun();
        for file in &begun.files {
            // most have been named, or removed
            let _ = fs::remove_file(file);
        }
        for directory in &begun.directories {
            // those with something in them stay
            let _ = fs::remove_dir(directory);
        }
        // the first process of a container is ended by no signal
        if process::id() != 1 {
            let _ = signal_hook::low_level::emulate_default_handler(signal);
        }
        process::exit(128 + signal);
    }
}
