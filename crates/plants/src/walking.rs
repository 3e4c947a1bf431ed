//! Functions for walking: momentum about the centre of mass, and points of the ground that tell how
//! a robot keeps its balance.

use super::PlantModel;
use super::on_demand::OnDemand;
use denavit_codegen::function::FunctionName;

/// The functions of a plant for walking, in the world frame. Each is derived and compiled when it
/// is called first.
///
/// Momenta are those of the bodies; rotors of drives do not count, as in
/// [`Plant::momentum`](super::Plant::momentum). Points of the ground are there where the base
/// floats and the robot has contact points; positions, velocities and accelerations have n
/// entries.
#[derive(Debug)]
pub struct WalkingFunctions<'a> {
    model: &'a PlantModel,
    functions: &'a mut OnDemand,
}

impl<'a> WalkingFunctions<'a> {
    pub(crate) fn new(model: &'a PlantModel, functions: &'a mut OnDemand) -> Self {
        Self { model, functions }
    }

    /// (d/dt J) qd [m/s^2], with J the Jacobian of the centre of mass, whose velocity is J qd.
    pub fn center_of_mass_bias(&mut self, q: &[f64], qd: &[f64]) -> [f64; 3] {
        self.always(FunctionName::CenterOfMassBias, &[q, qd])
    }

    /// A(q), 6 x n, row-major: A qd is the linear momentum [kg m/s], then the angular momentum
    /// about the centre of mass [kg m^2/s].
    pub fn centroidal_momentum_matrix(&mut self, q: &[f64], matrix: &mut [f64]) {
        let name = FunctionName::CentroidalMomentumMatrix;
        assert!(self.functions.call(name, None, &[q], &mut [matrix]), "every robot has it");
    }

    /// (d/dt A) qd [N, N m].
    pub fn centroidal_momentum_bias(&mut self, q: &[f64], qd: &[f64]) -> [f64; 6] {
        self.always(FunctionName::CentroidalMomentumBias, &[q, qd])
    }

    /// Angular momentum of the body that each joint moves about the centre of mass of all, n x 3,
    /// row-major [kg m^2/s]: what [`Plant::momentum`](super::Plant::momentum) adds up.
    pub fn angular_momenta(&mut self, q: &[f64], qd: &[f64], momenta: &mut [f64]) {
        let name = FunctionName::AngularMomenta;
        assert!(self.functions.call(name, None, &[q, qd], &mut [momenta]), "every robot has it");
    }

    /// The point of the ground plane about which gravity and inertia have no moment but along the
    /// plane's normal \[m\]. Not finite where the ground need not press: in free flight.
    pub fn zero_moment_point(&mut self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Option<[f64; 3]> {
        self.point(FunctionName::ZeroMomentPoint, None, &[q, qd, qdd])
    }

    /// The zero-moment point of the cart-table model \[m\]: the centre of mass on the ground plane,
    /// minus (a - g) h / gn, with a and g its acceleration and gravity along the plane, h its
    /// height and gn gravity across the plane.
    pub fn cart_table_zmp(&mut self, q: &[f64], qd: &[f64], qdd: &[f64]) -> Option<[f64; 3]> {
        self.point(FunctionName::CartTableZmp, None, &[q, qd, qdd])
    }

    /// The foot rotation indicator (Goswami 1999) of a link that carries contact points \[m\]:
    /// where on the ground plane the ground would have to act to keep the link's body still, all
    /// others in the motion given. `link` is a row of [`PlantModel::links`].
    pub fn foot_rotation_indicator(
        &mut self,
        link: usize,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
    ) -> Option<[f64; 3]> {
        let carries = |link: usize| self.model.contacts.iter().any(|point| point.link == link);
        if !carries(link) {
            return None;
        }
        self.point(FunctionName::FootRotationIndicator, Some(link), &[q, qd, qdd])
    }

    /// The capture point of the linear inverted pendulum \[m\]: c + v sqrt(h / gn), with c the
    /// centre of mass taken to the ground plane along gravity and v its velocity along the plane.
    /// Not a number where the centre of mass is below the plane.
    pub fn capture_point(&mut self, q: &[f64], qd: &[f64]) -> Option<[f64; 3]> {
        self.point(FunctionName::CapturePoint, None, &[q, qd])
    }

    /// The entries of a function that every robot has.
    fn always<const N: usize>(&mut self, name: FunctionName, arguments: &[&[f64]]) -> [f64; N] {
        let mut entries = [0.0; N];
        let has = self.functions.call(name, None, arguments, &mut [&mut entries]);
        assert!(has, "every robot has {name}");
        entries
    }

    fn point(
        &mut self,
        name: FunctionName,
        link: Option<usize>,
        arguments: &[&[f64]],
    ) -> Option<[f64; 3]> {
        let mut point = [0.0; 3];
        self.functions.call(name, link, arguments, &mut [&mut point]).then_some(point)
    }
}
