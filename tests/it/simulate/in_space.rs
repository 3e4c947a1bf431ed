//! Rigid bodies in space on contact points, and what they do under dry friction.

use denavit::model;
use denavit::plants::InterpretedPlant;

/// A rigid body; its coordinates are z, x, y, yaw, roll and pitch.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) mass: f64,
    pub(super) center: [f64; 3],
    /// About the center of mass.
    pub(super) inertia: [f64; 3],
    pub(super) contacts: Vec<[f64; 3]>,
    pub(super) gravity: [f64; 3],
}

impl Body {
    /// A homogeneous block of these half edges: its lower four corners, or all eight.
    pub(super) fn block(half: [f64; 3], corners: usize) -> Self {
        let mass = 2.0;
        let [x, y, z] = half.map(|half| half * half);
        let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
        let layer = |z: f64| signs.map(|[x, y]| [x * half[0], y * half[1], z]);
        let layers = [layer(-half[2]), layer(half[2])];
        Self {
            mass,
            center: [0.0; 3],
            inertia: [y + z, x + z, x + y].map(|sum| mass * sum / 3.0),
            contacts: layers.into_iter().flatten().take(corners).collect(),
            gravity: [0.0, 0.0, -9.81],
        }
    }

    /// With gravity as on a slope of this tangent, which falls along x.
    pub(super) fn on_slope(mut self, tangent: f64) -> Self {
        let size = 9.81 / 1.0_f64.hypot(tangent);
        self.gravity = [size * tangent, 0.0, -size];
        self
    }

    pub(super) fn plant(&self) -> InterpretedPlant {
        let contacts: Vec<_> = (0..self.contacts.len())
            .map(|index| {
                serde_json::json!({"name": format!("p{index}"), "link": "base_pitch",
                    "position": self.contacts[index]})
            })
            .collect();
        let [xx, yy, zz] = self.inertia;
        let file = serde_json::json!({
            "format": "denavit-model/1",
            "name": "body",
            "convention": "standard",
            "gravity": self.gravity,
            "base": {"type": "floating", "body": {"mass": self.mass, "com": self.center,
                "inertia": {"xx": xx, "yy": yy, "zz": zz}, "about": "com"}},
            "links": [{"name": "tail", "parent": "base", "joint": {"type": "fixed"}}],
            "contacts": contacts,
            "ground": {"point": [0, 0, 0], "normal": [0, 0, 1]},
        });
        let robot = model::read("body", file.to_string().as_bytes()).unwrap();
        InterpretedPlant::new(&robot, &[]).unwrap()
    }
}

/// Three corners of a block that is not homogeneous.
pub(super) fn tetrahedral() -> Body {
    Body {
        inertia: [0.05, 0.06, 0.07],
        contacts: vec![[0.2, 0.1, -0.05], [-0.2, -0.1, -0.05], [-0.2, 0.1, -0.05]],
        ..Body::block([0.2, 0.1, 0.05], 0)
    }
}
