//! The project is its own first client: these robots become modules of Rust, tulip_leg6, with
//! products fused, for benches and tests alone, planar_biped with what a simulation needs. All
//! others are read at run time.

use denavit_codegen::build_script::{Request, emit, emit_with};
use denavit_codegen::function::FunctionName;

const OF_A_PLANT: [FunctionName; 12] = [
    FunctionName::MassMatrix,
    FunctionName::Bias,
    FunctionName::LinkTransforms,
    FunctionName::ContactPositions,
    FunctionName::ContactJacobian,
    FunctionName::ContactBias,
    FunctionName::KineticEnergy,
    FunctionName::PotentialEnergy,
    FunctionName::CenterOfMass,
    FunctionName::Momentum,
    FunctionName::InverseDynamicsDerivatives,
    FunctionName::ContactDerivatives,
];

fn main() {
    emit("models/puma560.json");
    let functions = [&FunctionName::ALL[..], &[FunctionName::ContactDerivatives]].concat();
    emit_with("models/tulip.json", &Request { functions, ..Request::default() });
    let functions = [&FunctionName::ALL[..], &[FunctionName::BaseRegressor]].concat();
    emit_with("models/tulip_leg6.json", &Request { functions, fuses: true, ..Request::default() });
    let request = Request { functions: OF_A_PLANT.to_vec(), ..Request::default() };
    emit_with("models/planar_biped.json", &request);
}
