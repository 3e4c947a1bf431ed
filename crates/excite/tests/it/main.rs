//! Trajectories that excite: their spaces, the search, its files.

mod files;
mod search;
mod spaces;

use denavit_codegen::model::{self, Robot};
use denavit_plants::shipped;

fn shipped_robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("a sound model")
}

/// A planar arm of two joints with limits of everything, and a tip that must not touch.
fn arm(position2: &str, extra: &str) -> Robot {
    let link = |name: &str, position: &str| {
        format!(
            "{{\"name\": \"{name}\", \"joint\": {{\"type\": \"revolute\", \"a\": 0.5}}, \
             \"limits\": {{\"position\": {position}, \"velocity\": 4, \"acceleration\": 20, \
             \"torque\": [-30, 30]}}, \"body\": {{\"mass\": 1.5, \"com\": [-0.2, 0, 0], \
             \"inertia\": {{\"zz\": 0.03}}, \"about\": \"com\"}}}}"
        )
    };
    let text = format!(
        "{{\"format\": \"denavit-model/1\", \"name\": \"arm\", \"convention\": \"standard\", \
         \"gravity\": [0, -9.81, 0], \"links\": [{}, {}], \"drives\": {{\"link2\": \
         {{\"viscous\": 0.1, \"coulomb\": 0.5}}}}{extra}}}",
        link("link1", "[-1.5, 1.5]"),
        link("link2", position2)
    );
    model::read("arm.json", text.as_bytes()).expect("a sound model")
}
