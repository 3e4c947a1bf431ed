//! Random robots: trees of joints with bodies of all ten parameters.

use serde_json::{Value, json};

/// Pseudo-random numbers of a seed.
struct Random(u64);

impl Random {
    /// A number below a bound.
    fn below(&mut self, bound: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % bound
    }
}

/// The model file of a random tree: quarter-turn twists, one joint in four slides, lengths that
/// are 0, numbers or one of four symbols, each link carried by one of the two before it.
pub(crate) fn random_tree(joints: usize, seed: u64) -> Vec<u8> {
    let mut random = Random(seed);
    let mut links: Vec<Value> = Vec::new();
    for j in 0..joints {
        let mut length = || match random.below(3) {
            0 => json!(0),
            1 => json!(1 + random.below(5)),
            _ => json!(format!("x{}", random.below(4))),
        };
        let (a, d) = (length(), length());
        let alpha = ["0", "pi/2", "-pi/2", "0"][random.below(4) as usize];
        let kind = if random.below(4) == 0 { "prismatic" } else { "revolute" };
        let parent = match j.checked_sub(1 + random.below(2) as usize) {
            Some(parent) => format!("l{parent}"),
            None => "base".to_owned(),
        };
        links.push(json!({
            "name": format!("l{j}"),
            "parent": parent,
            "joint": {"type": kind, "a": a, "alpha": alpha, "d": d},
            "body": {"mass": 1, "com": [0, 0, 0], "inertia": {"xx": 1, "yy": 1, "zz": 1},
                     "about": "origin"},
        }));
    }
    let length = json!({"value": 0.5, "unit": "m"});
    let file = json!({
        "format": "denavit-model/1",
        "name": "random",
        "description": "of the tests",
        "source": "made up",
        "convention": "standard",
        "gravity": [0, 0, "-g"],
        "constants": {"g": {"value": 9.81, "unit": "m/s^2"},
                      "x0": length, "x1": length, "x2": length, "x3": length},
        "links": links,
    });
    serde_json::to_vec(&file).expect("text")
}
