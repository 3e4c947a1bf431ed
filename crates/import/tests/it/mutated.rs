//! Descriptions with a few wrong bytes: whatever they become, the answer is a model or faults.

use crate::evaluated::Random;
use denavit_codegen::model;
use denavit_import::{BaseChoice, Beside, Mimic, Options, export_into, import};

const SEEDS: [&str; 2] =
    [include_str!("../robots/gantry.urdf"), include_str!("../robots/hopper.xml")];
const MUTATIONS: usize = 1500;

/// Words that files of both kinds have, and numbers at their ends.
const WORDS: [&str; 24] = [
    "0",
    "-1",
    "1e300",
    "1e-300",
    "nan",
    "inf",
    "1.57",
    "\"",
    "<",
    ">",
    "/>",
    "&amp;",
    "&lt;",
    "type=\"ball\"",
    "type=\"floating\"",
    "<joint/>",
    "<frame euler=\"1 2 3\">",
    "<link name=\"a\"/>",
    "0 0 0",
    "1e999",
    "${x}",
    "99999999999999999999999999999999999999",
    "<![CDATA[",
    "é",
];

fn mutated(seed: &str, random: &mut Random) -> Vec<u8> {
    let mut bytes = seed.as_bytes().to_vec();
    for _ in 0..=random.whole(2) {
        let at = random.whole(bytes.len() as u64) as usize;
        let to = (at + random.whole(40) as usize).min(bytes.len());
        match random.whole(6) {
            0 => bytes[at] = random.whole(256) as u8,
            1 => drop(bytes.drain(at..to)),
            2 => {
                let copy = bytes[at..to].to_vec();
                let place = random.whole(bytes.len() as u64) as usize;
                drop(bytes.splice(place..place, copy));
            }
            3 => bytes.truncate(at.max(1)),
            _ => {
                let word = WORDS[random.whole(WORDS.len() as u64) as usize];
                // in place of a value, often
                let ends = |byte: &u8| matches!(byte, b'"' | b' ' | b'>');
                let start = (0..at).rev().find(|&k| ends(&bytes[k])).map_or(at, |k| k + 1);
                let end = (at..bytes.len()).find(|&k| ends(&bytes[k])).unwrap_or(at);
                drop(bytes.splice(start.min(end)..end, word.bytes()));
            }
        }
        if bytes.is_empty() {
            bytes.push(b'<');
        }
    }
    bytes
}

#[test]
fn no_mutation_is_more_than_a_fault() {
    let mut random = Random(29);
    let (mut read, mut refused) = (0, 0);
    for seed in SEEDS {
        for _ in 0..MUTATIONS {
            let bytes = mutated(seed, &mut random);
            let base = [BaseChoice::AsDescribed, BaseChoice::Floating];
            let is_urdf = seed == SEEDS[0];
            let options = Options {
                base: base[random.whole(1 + u64::from(is_urdf)) as usize],
                mimic: Mimic::Free,
                contacts: ["foot"]
                    .iter()
                    .take(random.whole(1 + u64::from(is_urdf)) as usize)
                    .map(|&s| s.to_owned())
                    .collect(),
                tip: None,
            };
            let mut include = |_: Beside<'_>| Ok(bytes.clone());
            match import("m.xml", &bytes, &options, &mut include) {
                Ok(found) => {
                    let robot = model::read("m.json", found.model.as_bytes()).expect("checked");
                    // values of another model go in, or they do not
                    let _ = export_into(&robot, "m.xml", &bytes);
                    read += 1;
                }
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(read > MUTATIONS / 10 && refused > MUTATIONS / 4, "{read} read, {refused} refused");
}
