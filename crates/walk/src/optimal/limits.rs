//! What a planned step must keep to, in numbers.

/// Limits and margins of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Walking speed [m/s].
    pub speed_m_s: f64,
    /// Length of a step; none leaves it free \[m\].
    pub step_length_m: Option<f64>,
    /// Coefficient of friction that forces and impulses stay within.
    pub friction: f64,
    /// Height of the swing foot's heel and toe over the ground in the middle of its flight \[m\].
    pub clearance_m: f64,
    /// Share of the flight in which the clearance is reached, and left.
    pub clearance_ramp: f64,
    /// Largest torque of a joint; none leaves the model's own \[N m\].
    pub torque_nm: Option<f64>,
    /// Least normal force of a closed contact, in weights.
    pub contact_force: f64,
    /// Least speed downwards of a contact that closes [m/s].
    pub touchdown_m_s: f64,
    /// Least duration of a phase \[s\].
    pub phase_s: f64,
    /// Distance from the model's limits of positions \[rad\].
    pub position_margin_rad: f64,
    /// Largest lean of the torso to either side \[rad\].
    pub lean_rad: f64,
    /// Largest bend of the stance knee while its foot alone is on the ground \[rad\].
    pub stance_knee_rad: f64,
    /// Least angular velocity forwards of the swing thigh as its foot strikes the ground; negative
    /// ones are a leg that retracts [rad/s].
    pub thigh_rad_s: f64,
}

impl Default for StepLimits {
    fn default() -> Self {
        Self {
            speed_m_s: 0.5,
            step_length_m: None,
            friction: 0.6,
            clearance_m: 0.02,
            clearance_ramp: 0.3,
            torque_nm: None,
            contact_force: 0.2,
            touchdown_m_s: 0.1,
            phase_s: 0.05,
            position_margin_rad: 0.05,
            lean_rad: f64::INFINITY,
            stance_knee_rad: f64::INFINITY,
            thigh_rad_s: f64::NEG_INFINITY,
        }
    }
}
