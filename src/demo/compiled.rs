//! The functions that `build.rs` generated, behind slices.

/// Generated functions of one robot, with the parameters of its model.
pub struct Compiled {
    /// The model's name.
    pub name: &'static str,
    /// tau of q, qd, qdd.
    pub(super) inverse_dynamics: fn([&[f64]; 3]) -> Vec<f64>,
    /// qdd of q, qd, tau.
    pub(super) forward_dynamics: fn([&[f64]; 3]) -> Vec<f64>,
    /// D, row-major, of q.
    pub(super) mass_matrix: fn(&[f64]) -> Vec<f64>,
    /// C, row-major, of q, qd.
    pub(super) coriolis_matrix: fn([&[f64]; 2]) -> Vec<f64>,
    /// G of q.
    pub(super) gravity_vector: fn(&[f64]) -> Vec<f64>,
    /// Kinetic energy of q, qd.
    pub(super) kinetic_energy: fn([&[f64]; 2]) -> f64,
}

macro_rules! compiled {
    ($($robot:ident),*) => {
        [$({
            use denavit::$robot as robot;

            fn parameters() -> robot::Parameters<f64> {
                robot::Parameters::default()
            }

            fn sized(values: &[f64]) -> [f64; robot::DOF] {
                values.try_into().expect("one value for each joint")
            }

            Compiled {
                name: stringify!($robot),
                inverse_dynamics: |arguments| {
                    let [q, qd, qdd] = arguments.map(sized);
                    robot::inverse_dynamics(&parameters(), &q, &qd, &qdd).to_vec()
                },
                forward_dynamics: |arguments| {
                    let [q, qd, tau] = arguments.map(sized);
                    robot::forward_dynamics(&parameters(), &q, &qd, &tau).to_vec()
                },
                mass_matrix: |q| robot::mass_matrix(&parameters(), &sized(q)).concat(),
                coriolis_matrix: |arguments| {
                    let [q, qd] = arguments.map(sized);
                    robot::coriolis_matrix(&parameters(), &q, &qd).concat()
                },
                gravity_vector: |q| robot::gravity_vector(&parameters(), &sized(q)).to_vec(),
                kinetic_energy: |arguments| {
                    let [q, qd] = arguments.map(sized);
                    robot::kinetic_energy(&parameters(), &q, &qd)
                },
            }
        }),*]
    };
}

/// The robots of the demo.
pub static ROBOTS: [Compiled; 2] = compiled![tulip, puma560];
