//! Robots that others describe, as model files: exact Denavit-Hartenberg tables of URDF and MJCF.
//!
//! 1. `xml`: text to elements with places, within bounds, nothing expanded
//! 2. `urdf`, `mjcf`: elements to one tree of links and joints; decimals stay rationals, turns stay
//!    what the file says (`place`)
//! 3. `layout`: the tree to rows, as few as can be
//! 4. `model`: rows to the text of a model file
//!
//! [`shapes`] are what links look like, for pictures.
//!
//! Nothing is computed in floating point. What a model file cannot say exactly (a tensor in axes
//! that are turned by 0.3) is rounded at 17 digits, and reported.

mod body;
mod chain;
mod contact;
mod drawn;
mod error;
mod exact;
mod export;
mod fault;
mod json;
mod layout;
mod looks;
mod mesh;
mod mjcf;
mod model;
mod names;
mod options;
mod place;
mod solid;
mod tree;
mod urdf;
mod xml;

pub use drawn::{Drawn, DrawnForm, DrawnShape, shapes};
pub use error::{Error, ErrorKind};
pub use export::{Exported, Format, export, export_into};
pub use fault::Cause;
pub use options::{BaseChoice, Mimic, Options};

use denavit_codegen::model::Report;
use std::collections::BTreeMap;
use xml::Source;

/// What became of a description.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The text of the model file.
    pub model: String,
    /// What the author of the description should know.
    pub notes: Vec<String>,
}

/// Whether a file is a description of another format, by its first characters: XML.
pub fn is_description(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    text.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'<')
}

/// Most files that a description may include.
const MAX_INCLUDED: usize = 64;

/// Another file that a description names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Beside<'n> {
    /// A file that an MJCF includes.
    Description(&'n str),
    /// A mesh of a link that is to have contact points: a path, perhaps behind `package://`.
    Mesh(&'n str),
}

/// What another file holds; a sentence if it cannot be read.
pub type Include<'i> = dyn FnMut(Beside<'_>) -> Result<Vec<u8>, String> + 'i;

/// The model of a description. `file` is its name, for messages and the model's description;
/// `include` reads the files that it names, and decides which it may.
pub fn import(
    file: &str,
    bytes: &[u8],
    options: &Options,
    include: &mut Include<'_>,
) -> Result<Imported, Error> {
    let source = Source::read(file, bytes)?;
    let mut faults = Report::default();
    let refused = |faults: fault::Faults| Err(Error::from(faults.into_error(file, bytes, None)));
    let Some(document) = source.document() else { return refused(faults) };
    let root = source.root(&document);
    let name = short_name(file);
    let tree = match root.name() {
        "robot" => urdf::tree(name, root, options, include, &mut faults),
        "mujoco" => with_included(root, include, &mut faults, |included, include, faults| {
            mjcf::tree(name, root, included, options, include, faults)
        }),
        other => {
            let said =
                format!("<{}> is neither <robot> (URDF) nor <mujoco> (MJCF)", fault::clip(other));
            faults.push(root.at(), Cause::new(said));
            None
        }
    };
    let Some(tree) = tree else { return refused(faults) };
    let layout = layout::layout(&tree);
    let model = model::text(&tree, &layout);
    if let Err(error) = denavit_codegen::model::read(file, model.as_bytes()) {
        for fault in error.faults {
            let said = format!("the model made of it is refused: {}", fault.cause);
            faults.push(0, Cause::new(said));
        }
        return refused(faults);
    }
    Ok(Imported { model, notes: tree.notes })
}

/// What `read` makes of a description and the files that it includes; nothing if one is at fault.
fn with_included<T>(
    root: xml::Element<'_>,
    include: &mut Include<'_>,
    faults: &mut fault::Faults,
    read: impl FnOnce(
        BTreeMap<String, xml::Element<'_>>,
        &mut Include<'_>,
        &mut fault::Faults,
    ) -> Option<T>,
) -> Option<T> {
    let files = included_files(root, include, faults);
    if !faults.is_empty() {
        return None;
    }
    let sources: Vec<(String, Source<'_>, usize)> = files
        .iter()
        .filter_map(|(name, bytes, at)| match Source::read(name, bytes) {
            Ok(source) => Some((name.clone(), source, *at)),
            Err(error) => {
                faults.push(*at, Cause::new(error.to_string()));
                None
            }
        })
        .collect();
    let documents: Vec<_> = sources
        .iter()
        .filter_map(|(name, source, at)| Some((name, source, source.document()?, *at)))
        .collect();
    let included = documents
        .iter()
        .map(|(name, source, document, at)| ((*name).clone(), source.included(document, *at)))
        .collect();
    read(included, include, faults)
}

/// The files that a description includes, and those that they include, with the places where the
/// first one does.
fn included_files(
    root: xml::Element<'_>,
    include: &mut Include<'_>,
    faults: &mut fault::Faults,
) -> Vec<(String, Vec<u8>, usize)> {
    let names = |root: xml::Element<'_>, at: Option<usize>| -> Vec<(String, usize)> {
        let all = root.everything().filter(|element| element.name() == "include");
        let files =
            all.filter_map(|element| Some((element.get("file")?.text.to_owned(), element.at())));
        files.map(|(name, own)| (name, at.unwrap_or(own))).collect()
    };
    let mut waiting = names(root, None);
    let mut found: Vec<(String, Vec<u8>, usize)> = Vec::new();
    while let Some((name, at)) = waiting.pop() {
        // so that inclusions end, and no file becomes many
        if found.iter().any(|(known, ..)| *known == name) {
            faults.push(at, Cause::new(format!("{} is included twice", fault::clip(&name))));
            break;
        }
        if found.len() == MAX_INCLUDED {
            faults.push(at, Cause::new(format!("more than {MAX_INCLUDED} files are included")));
            break;
        }
        match include(Beside::Description(&name)) {
            Err(why) => {
                faults
                    .push(at, Cause::new(format!("{} is not included: {why}", fault::clip(&name))));
            }
            Ok(bytes) => {
                if let Ok(source) = Source::read(&name, &bytes)
                    && let Some(document) = source.document()
                {
                    waiting.extend(names(source.root(&document), Some(at)));
                }
                found.push((name, bytes, at));
            }
        }
    }
    found
}

/// Includes nothing: for descriptions that stand alone.
pub fn nothing_included(_: Beside<'_>) -> Result<Vec<u8>, String> {
    Err("a description from here stands alone".to_owned())
}

/// The last part of a path.
fn short_name(file: &str) -> &str {
    file.rsplit(['/', '\\']).next().unwrap_or(file)
}
