//! The modules that `build.rs` generated, as plants.

use super::model::baked;
use super::on_demand::OnDemand;
use super::{ContactDerivatives, LoadedPlant, Override, Plant, PlantModel, WalkingFunctions};
use crate::error::Error;
use crate::shipped;
use denavit_codegen::model::{self, Robot};

/// The plant of a robot: the generated module if it is the shipped model that the module was made
/// of and no value differs that the module's plant cannot set, else loaded and compiled in memory.
pub fn plant_of(robot: &Robot, overrides: &[Override]) -> Result<Box<dyn Plant>, Error> {
    let made: [(&str, Make); 3] =
        [("tulip", tulip), ("puma560", puma560), ("planar_biped", planar_biped)];
    for (name, make) in made {
        if robot.name == name
            && robot.hash == shipped_robot(name).hash
            && let Some(plant) = make(overrides)
        {
            return Ok(plant);
        }
    }
    Ok(Box::new(LoadedPlant::new(robot, overrides)?))
}

type Make = fn(&[Override]) -> Option<Box<dyn Plant>>;

fn shipped_robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("the module was made of a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("shipped models are sound")
}

/// Coulomb friction is part of the emitted bias: what it adds is taken off again.
fn without_coulomb(model: &PlantModel, qd: &[f64], bias: &mut [f64]) {
    for ((joint, rate), entry) in model.joints.iter().zip(qd).zip(bias) {
        if joint.coulomb != 0.0 && *rate != 0.0 {
            *entry -= joint.coulomb * rate.signum();
        }
    }
}

/// The functions that every module has.
macro_rules! functions {
    () => {
        fn mass_matrix(&mut self, q: &[f64], mass: &mut [f64]) {
            let rows = robot::mass_matrix(&self.parameters, sized(q));
            mass.copy_from_slice(rows.as_flattened());
        }

        fn bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]) {
            bias.copy_from_slice(&robot::bias(&self.parameters, sized(q), sized(qd)));
            without_coulomb(&self.model, qd, bias);
        }

        fn center_of_mass_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]) {
            let rows = robot::center_of_mass_jacobian(&self.parameters, sized(q));
            jacobian.copy_from_slice(rows.as_flattened());
        }

        fn walking(&mut self) -> Option<WalkingFunctions<'_>> {
            Some(WalkingFunctions::new(&self.model, &mut self.on_demand))
        }

        fn inverse_dynamics_derivatives(
            &mut self,
            q: &[f64],
            qd: &[f64],
            qdd: &[f64],
            by_position: &mut [f64],
            by_velocity: &mut [f64],
        ) -> bool {
            let found = robot::inverse_dynamics_derivatives(
                &self.parameters,
                sized(q),
                sized(qd),
                sized(qdd),
            );
            by_position.copy_from_slice(found.dtau_dq.as_flattened());
            by_velocity.copy_from_slice(found.dtau_dqd.as_flattened());
            true
        }

        fn kinetic_energy(&mut self, q: &[f64], qd: &[f64]) -> f64 {
            robot::kinetic_energy(&self.parameters, sized(q), sized(qd))
        }

        fn potential_energy(&mut self, q: &[f64]) -> f64 {
            robot::potential_energy(&self.parameters, sized(q))
        }

        fn center_of_mass(&mut self, q: &[f64]) -> [f64; 3] {
            robot::center_of_mass(&self.parameters, sized(q))
        }

        fn momentum(&mut self, q: &[f64], qd: &[f64]) -> [f64; 6] {
            let found = robot::momentum(&self.parameters, sized(q), sized(qd));
            let ([x, y, z], [a, b, c]) = (found.linear_momentum, found.angular_momentum);
            [x, y, z, a, b, c]
        }

        fn link_transforms(&mut self, q: &[f64], transforms: &mut [f64]) {
            let links = robot::link_transforms(&self.parameters, sized(q));
            transforms.copy_from_slice(links.as_flattened().as_flattened());
        }
    };
}

macro_rules! generated {
    ($(#[$doc:meta])* $robot:ident, [$($settable:ident),*], $contacts:ident) => {
        $(#[$doc])*
        pub fn $robot(overrides: &[Override]) -> Option<Box<dyn Plant>> {
            use crate::emitted::$robot as robot;

            struct Generated {
                model: PlantModel,
                parameters: robot::Parameters<f64>,
                /// What the module does not have.
                on_demand: OnDemand,
            }

            fn sized(values: &[f64]) -> &[f64; robot::DOF] {
                values.try_into().expect("one value for each joint")
            }

            impl Plant for Generated {
                fn model(&self) -> &PlantModel {
                    &self.model
                }

                functions!();

                $contacts!();
            }

            #[allow(unused_mut)] // a robot may have nothing to set
            let mut parameters = robot::ModelParameters::<f64>::default();
            for given in overrides {
                match given.parameter.as_str() {
                    $(stringify!($settable) => parameters.$settable = given.value,)*
                    _ => return None,
                }
            }
            // a value that cannot be baked is the interpreter's to refuse
            let robot = baked(&shipped_robot(stringify!($robot)), overrides).ok()?;
            let model = PlantModel::of_baked(&robot);
            let parameters = robot::Parameters::new(&parameters);
            let on_demand = OnDemand::new(robot);
            Some(Box::new(Generated { model, parameters, on_demand }))
        }
    };
}

macro_rules! contacts {
    () => {
        fn contact_positions(&mut self, q: &[f64], positions: &mut [f64]) {
            let points = robot::contact_positions(&self.parameters, sized(q));
            positions.copy_from_slice(points.as_flattened());
        }

        fn contact_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]) {
            let rows = robot::contact_jacobian(&self.parameters, sized(q));
            jacobian.copy_from_slice(rows.as_flattened());
        }

        fn contact_bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]) {
            let rows = robot::contact_bias(&self.parameters, sized(q), sized(qd));
            bias.copy_from_slice(&rows);
        }

        fn contact_derivatives(
            &mut self,
            q: &[f64],
            qd: &[f64],
            qdd: &[f64],
            f: &[f64],
            derivatives: &mut ContactDerivatives,
        ) -> bool {
            let f = f.try_into().expect("three entries for each contact point");
            let (q, qd, qdd) = (sized(q), sized(qd), sized(qdd));
            let found = robot::contact_derivatives(&self.parameters, q, qd, qdd, f);
            derivatives.velocity_dq.copy_from_slice(found.contact_velocity_dq.as_flattened());
            let accelerations = found.contact_acceleration_dq;
            derivatives.acceleration_dq.copy_from_slice(accelerations.as_flattened());
            let accelerations = found.contact_acceleration_dqd;
            derivatives.acceleration_dqd.copy_from_slice(accelerations.as_flattened());
            derivatives.torque_dq.copy_from_slice(found.contact_torque_dq.as_flattened());
            true
        }
    };
}

macro_rules! no_contacts {
    () => {
        fn contact_positions(&mut self, _q: &[f64], _positions: &mut [f64]) {}

        fn contact_jacobian(&mut self, _q: &[f64], _jacobian: &mut [f64]) {}

        fn contact_bias(&mut self, _q: &[f64], _qd: &[f64], _bias: &mut [f64]) {}

        fn contact_derivatives(
            &mut self,
            _q: &[f64],
            _qd: &[f64],
            _qdd: &[f64],
            _f: &[f64],
            derivatives: &mut ContactDerivatives,
        ) -> bool {
            derivatives.torque_dq.fill(0.0);
            true
        }
    };
}

generated! {
    /// TUlip as generated code; none if an override is not stiffness, damping or rest angle of an
    /// ankle roll.
    tulip,
    [
        ks_right_ankle_x, ks_left_ankle_x, qs_right_ankle_x, qs_left_ankle_x, fv_right_ankle_x,
        fv_left_ankle_x
    ],
    contacts
}

generated! {
    /// The PUMA 560 as generated code; none if there are overrides.
    puma560,
    [],
    no_contacts
}

generated! {
    /// The planar biped as generated code; none if there are overrides.
    planar_biped,
    [],
    contacts
}
