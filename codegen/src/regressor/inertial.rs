//! The ten numbers of a body in both languages: entries of its pseudo-inertia, in which everything
//! is linear, and the parameters that users know: mass, first moment and inertia tensor.

use crate::expr::{Dag, ExprId};
use crate::model::{About, Body};
use crate::spatial::PseudoInertia;

/// The entries of a pseudo-inertia, in the order m, s1, s2, s3, K11, K22, K33, K12, K13, K23.
pub(super) const ENTRIES: usize = 10;

/// The places of the second moments.
pub(super) const SECOND: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// The entries of a pseudo-inertia as a list.
pub(super) fn entries(inertia: &PseudoInertia) -> [ExprId; ENTRIES] {
    let (s, k) = (inertia.first, &inertia.second);
    let [k11, k22, k33, k12, k13, k23] = SECOND.map(|(i, j)| k[i][j]);
    [inertia.mass, s[0], s[1], s[2], k11, k22, k33, k12, k13, k23]
}

/// The pseudo-inertia of a list of entries.
pub(super) fn from_entries(entries: [ExprId; ENTRIES]) -> PseudoInertia {
    let [mass, x, y, z, k11, k22, k33, k12, k13, k23] = entries;
    PseudoInertia {
        second: [[k11, k12, k13], [k12, k22, k23], [k13, k23, k33]],
        first: [x, y, z],
        mass,
    }
}

/// The prefixes and units of the ten parameters about the origin of the link frame.
pub(super) const PARAMETERS: [(&str, &str); ENTRIES] = [
    ("m", "kg"),
    ("mx", "kg m"),
    ("my", "kg m"),
    ("mz", "kg m"),
    ("Ixx", "kg m^2"),
    ("Iyy", "kg m^2"),
    ("Izz", "kg m^2"),
    ("Ixy", "kg m^2"),
    ("Ixz", "kg m^2"),
    ("Iyz", "kg m^2"),
];

/// The matter of one unit of one parameter.
pub(super) fn unit_matter(dag: &mut Dag, place: usize) -> PseudoInertia {
    let (zero, one) = (dag.zero(), dag.one());
    let unit = |at: usize| if at == place { one } else { zero };
    let mut matter =
        PseudoInertia::from_body(dag, zero, [zero; 3], [4, 5, 6, 7, 8, 9].map(unit), false);
    matter.mass = unit(0);
    matter.first = [1, 2, 3].map(unit);
    matter
}

/// Matter as the ten parameters of a frame.
pub(super) fn parameters_of(dag: &mut Dag, matter: &PseudoInertia) -> [ExprId; ENTRIES] {
    let tensor = matter.tensor(dag);
    let [x, y, z] = matter.first;
    let [xx, yy, zz] = [0, 1, 2].map(|i| tensor[i][i]);
    [matter.mass, x, y, z, xx, yy, zz, tensor[0][1], tensor[0][2], tensor[1][2]]
}

/// The ten parameters of a body about the origin of its frame, in the symbols of the model.
pub(super) fn about_origin(dag: &mut Dag, body: &Body) -> [ExprId; ENTRIES] {
    let first = body.com.map(|c| dag.mul(body.mass, c));
    let mut tensor = body.inertia;
    if body.about == About::Com {
        // Steiner: I + m (c.c 1 - c c^T)
        let c = body.com;
        let squares = [0, 1, 2].map(|k| dag.mul(first[k], c[k]));
        for (place, (i, j)) in [(1, 2), (0, 2), (0, 1)].into_iter().enumerate() {
            let sum = dag.add(squares[i], squares[j]);
            tensor[place] = dag.add(tensor[place], sum);
        }
        for (place, (i, j)) in [(0, 1), (0, 2), (1, 2)].into_iter().enumerate() {
            let product = dag.mul(first[i], c[j]);
            tensor[3 + place] = dag.sub(tensor[3 + place], product);
        }
    }
    let [xx, yy, zz, xy, xz, yz] = tensor;
    [body.mass, first[0], first[1], first[2], xx, yy, zz, xy, xz, yz]
}

/// The matter of a list of ten entries, all 0 but one.
pub(super) fn unit_entry(dag: &Dag, entry: usize) -> PseudoInertia {
    let mut list = [dag.zero(); ENTRIES];
    list[entry] = dag.one();
    from_entries(list)
}
