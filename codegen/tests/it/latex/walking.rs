//! Functions for walking as formulas.

use super::documents::{assert_reads_back, set};
use denavit_codegen::function::FunctionName;

#[test]
fn a_reader_finds_the_centroidal_matrix_in_the_document() {
    let wanted = [FunctionName::MassMatrix, FunctionName::CentroidalMomentumMatrix];
    for name in ["planar_2r", "scara", "puma560"] {
        assert_reads_back(name, &wanted, &["D", "A"]);
    }
}

#[test]
fn forces_bear_the_numbers_of_their_contact_points() {
    let (_, _, text) = set("planar_biped", &FunctionName::WALKING);
    for part in [
        r"\subsection{Contact velocity dq}",
        r"\subsection{Zero moment point}",
        r"\subsection{Foot rotation indicator right ankle}",
        r"\subsection{Centroidal momentum matrix}",
        r"\sqrt",
        "f_{x,1}",
        "f_{z,4}",
    ] {
        assert!(text.contains(part), "{part}");
    }
}
