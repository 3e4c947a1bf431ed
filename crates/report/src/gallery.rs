//! The results of a folder on one page, and what of it may be handed out.

use super::html::{Cell, Heading, HtmlTable, Page, Part, Row, Section};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// Folders below each other that are looked into.
const DEPTH: usize = 5;

/// Files that are listed, at most.
const MOST: usize = 2000;

/// How much of a page is read for its title and its verdict: more than its frame.
const HEAD: u64 = 64 * 1024;

/// Pages, pictures and tables, each with what a browser calls it.
const KINDS: [(&str, &str); 7] = [
    ("html", "text/html; charset=utf-8"),
    ("svg", "image/svg+xml"),
    ("png", "image/png"),
    ("json", "application/json"),
    ("csv", "text/csv; charset=utf-8"),
    ("tex", "text/plain; charset=utf-8"),
    ("md", "text/plain; charset=utf-8"),
];

/// A file of a folder of results.
#[derive(Clone, Debug)]
struct Found {
    path: PathBuf,
    kind: &'static str,
    changed: SystemTime,
    bytes: u64,
}

/// The results of a folder as they are now. Nothing else is handed out: not what is hidden, not
/// what a link leads to, not what is above the folder.
#[derive(Clone, Debug)]
pub struct Gallery {
    folder: PathBuf,
    /// By the path of a request, without the slash before it.
    files: BTreeMap<String, Found>,
}

impl Gallery {
    /// The results of a folder.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn read(folder: &Path) -> io::Result<Self> {
        let mut gallery = Self { folder: folder.to_owned(), files: BTreeMap::new() };
        gallery.look_into(folder, "", DEPTH)?;
        Ok(gallery)
    }

    /// The same without a file right in the folder: a page does not list itself.
    pub fn without(mut self, name: &str) -> Self {
        self.files.remove(name);
        self
    }

    fn look_into(&mut self, folder: &Path, prefix: &str, depth: usize) -> io::Result<()> {
        // in an order of their own, so that the same ones are left out where there are too many
        let mut entries = fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
        entries.sort_by_key(fs::DirEntry::file_name);
        for entry in entries {
            let Ok(name) = entry.file_name().into_string() else { continue };
            // a link is neither a file nor a folder here
            let (Ok(kind), Ok(about)) = (entry.file_type(), entry.metadata()) else { continue };
            if name.starts_with('.') || self.files.len() >= MOST {
                continue;
            }
            let key = format!("{prefix}{name}");
            if kind.is_dir() && depth > 0 {
                // one that cannot be read has no results
                let _ = self.look_into(&entry.path(), &format!("{key}/"), depth - 1);
            } else if let Some(kind) = kind_of(&name).filter(|_| kind.is_file()) {
                let changed = about.modified().unwrap_or(SystemTime::UNIX_EPOCH);
                let found = Found { path: entry.path(), kind, changed, bytes: about.len() };
                self.files.insert(key, found);
            }
        }
        Ok(())
    }

    /// A text that is another one as soon as a file is.
    pub fn stamp(&self) -> String {
        let mut hash = 0xcbf2_9ce4_8422_2325_u64;
        let mut add = |bytes: &[u8]| {
            for byte in bytes {
                hash = (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
            }
        };
        for (key, file) in &self.files {
            let since = file.changed.duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
            add(key.as_bytes());
            add(&since.as_nanos().to_le_bytes());
            add(&file.bytes.to_le_bytes());
        }
        format!("{hash:016x}")
    }

    /// The file that a request asks for, with what a browser calls it; none if it is none of the
    /// results.
    pub fn file(&self, request: &str) -> Option<(&Path, &'static str)> {
        let path = request.split(['?', '#']).next()?.strip_prefix('/')?;
        let found = self.files.get(&decoded(path)?)?;
        Some((&found.path, found.kind))
    }

    /// The page of all results, the newest first. One that watches its folder loads itself again
    /// when a file changes.
    pub fn page(&self, watches: bool) -> Page {
        let mut all: Vec<(&String, &Found)> = self.files.iter().collect();
        all.sort_by(|a, b| b.1.changed.cmp(&a.1.changed).then(a.0.cmp(b.0)));
        let (pages, others): (Vec<_>, Vec<_>) =
            all.into_iter().partition(|(_, file)| file.kind.starts_with("text/html"));
        let mut sections = Vec::new();
        for (heading, list) in [("Results", pages), ("Pictures and data", others)] {
            let rows: Vec<Row> = list.into_iter().map(|(key, file)| row(key, file)).collect();
            if !rows.is_empty() {
                let parts = vec![Part::Table(table(heading, rows))];
                sections.push(Section { heading: heading.to_owned(), parts });
            }
        }
        let name = self.folder.file_name().map(|name| name.to_string_lossy().into_owned());
        let lead = match self.files.len() {
            0 => "There are no results in this folder yet.".to_owned(),
            1 => "One result.".to_owned(),
            MOST => format!("{MOST} results, the newest first; more are left out."),
            count => format!("{count} results, the newest first."),
        };
        let title = format!("Results in {}", name.unwrap_or_else(|| "this folder".to_owned()));
        Page { title, lead, sections, watches, ..Page::default() }
    }
}

fn table(what: &str, rows: Vec<Row>) -> HtmlTable {
    let heading = |(text, is_number): (&str, bool)| Heading { heading: text.to_owned(), is_number };
    let columns = [("file", false), ("what it is", false), ("answer", false), ("size [kB]", true)];
    let caption = format!("{what}, the newest first; a click on a heading sorts them.");
    HtmlTable { caption, columns: columns.map(heading).to_vec(), rows }
}

fn row(key: &str, file: &Found) -> Row {
    let [title, answer] = match file.kind.starts_with("text/html") {
        true => told(&file.path),
        false => [String::new(), String::new()],
    };
    let size = file.bytes as f64 / 1000.0;
    let cells = vec![
        Cell::link(key, &encoded(key)),
        Cell::prose(title),
        Cell::prose(answer),
        Cell::number(size, format!("{size:.0}")),
    ];
    Row { cells, is_marked: false }
}

/// Title and verdict of a page.
fn told(path: &Path) -> [String; 2] {
    let mut bytes = Vec::new();
    let read = File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut bytes));
    let text = String::from_utf8_lossy(&bytes);
    if read.is_err() {
        return [String::new(), String::new()];
    }
    let between = |from: &str, to: &str| -> String {
        let rest = text.split_once(from).map_or("", |(_, rest)| rest);
        unescaped(rest.split_once(to).map_or("", |(inside, _)| inside))
    };
    let verdict = between("<p class=\"verdict", "</p>");
    let verdict = verdict.split_once('>').map_or("", |(_, text)| text).to_owned();
    [between("<title>", "</title>"), verdict]
}

/// Text without the names of letters that pages of ours use.
fn unescaped(text: &str) -> String {
    let names = [("&lt;", "<"), ("&gt;", ">"), ("&quot;", "\""), ("&#x27;", "'"), ("&#x2f;", "/")];
    let text = names.into_iter().fold(text.to_owned(), |text, (name, it)| text.replace(name, it));
    text.replace("&amp;", "&")
}

fn kind_of(name: &str) -> Option<&'static str> {
    let (_, ending) = name.rsplit_once('.')?;
    let ending = ending.to_ascii_lowercase();
    KINDS.iter().find(|(known, _)| *known == ending).map(|(_, kind)| *kind)
}

/// A path as part of an address.
fn encoded(path: &str) -> String {
    let mut out = String::new();
    for byte in path.bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'-' | b'_' | b'.' | b'~' | b'/' => {
                out.push(char::from(byte));
            }
            _ => out += &format!("%{byte:02X}"),
        }
    }
    // a name before a colon would be taken for a scheme
    format!("./{out}")
}

/// The path of an address; none where that is no text.
fn decoded(path: &str) -> Option<String> {
    let (mut bytes, mut rest) = (Vec::new(), path.bytes());
    while let Some(byte) = rest.next() {
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let [high, low] = [rest.next()?, rest.next()?].map(|digit| char::from(digit).to_digit(16));
        bytes.push(u8::try_from(16 * high? + low?).ok()?);
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_read_as_they_are_written() {
        for path in ["a b/c<d>.html", "\u{e4}%20.html", "java:script.html"] {
            let address = encoded(path);
            assert!(address.is_ascii() && !address.contains(['<', ' ']));
            assert_eq!(decoded(&address[2..]).as_deref(), Some(path));
        }
        assert_eq!(decoded("%zz"), None);
        assert_eq!(decoded("%"), None);
        assert_eq!(decoded("%ff"), None);
    }

    #[test]
    fn only_results_are_handed_out() {
        let folder = tempfile::tempdir().expect("a folder");
        let inside = folder.path().join("results");
        fs::create_dir_all(inside.join("deep")).expect("a folder");
        let files = ["a.html", "deep/b.svg", ".hidden.html", "key.pem"];
        files.iter().for_each(|file| fs::write(inside.join(file), "x").expect("written"));
        fs::write(folder.path().join("above.html"), "x").expect("written");
        #[cfg(unix)]
        std::os::unix::fs::symlink(folder.path().join("above.html"), inside.join("link.html"))
            .expect("a link");
        let gallery = Gallery::read(&inside).expect("read");
        assert!(gallery.file("/a.html?x#y").is_some() && gallery.file("/deep/b.svg").is_some());
        for request in [
            "/.hidden.html",
            "/key.pem",
            "/link.html",
            "/../above.html",
            "/%2e%2e/above.html",
            "/deep/../a.html",
            "//a.html",
            "a.html",
            "/",
            "",
        ] {
            assert!(gallery.file(request).is_none(), "{request}");
        }
        let before = gallery.stamp();
        assert_eq!(Gallery::read(&inside).expect("read").stamp(), before);
        fs::write(inside.join("a.html"), "longer").expect("written");
        assert_ne!(Gallery::read(&inside).expect("read").stamp(), before);
    }

    #[test]
    fn pages_are_listed_with_their_answers_as_text() {
        let folder = tempfile::tempdir().expect("a folder");
        let page = "<title>a &lt;b&gt;</title><p class=\"verdict good\">It &amp; that.</p>";
        fs::write(folder.path().join("a.html"), page).expect("written");
        let text = Gallery::read(folder.path()).expect("read").page(true).render();
        assert!(text.contains("a &lt;b&gt;") && text.contains("It &amp; that."));
        assert!(text.contains("href=\".&#x2f;a.html\"") && text.contains("connect-src 'self'"));
    }
}
