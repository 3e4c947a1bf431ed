//! Contact points against support functions: how far down a solid reaches, in closed form.

use crate::evaluated::{called, imported};
use denavit_codegen::function::FunctionName;
use denavit_import::{Options, import, nothing_included};

/// Heights in the world of the contact points of `foot`, at 0.
fn heights(text: &str) -> Vec<f64> {
    let options = Options { contacts: vec!["foot".to_owned()], ..Options::default() };
    let robot = imported(text, &options);
    let q = vec![0.0; robot.degrees_of_freedom()];
    let all = called(&robot, FunctionName::ContactPositions, &[&q]);
    all.chunks(3).map(|point| point[2]).collect()
}

/// An arm with a foot one metre up, whose geom is turned about x by degrees.
fn mjcf(geom: &str, degrees: f64) -> String {
    format!(
        "<mujoco><worldbody><body name=\"leg\"><joint name=\"hip\" axis=\"0 1 0\"/>\
         <inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>\
         <body name=\"foot\" pos=\"0.1 0.2 1\">\
         <geom pos=\"0 0 0.05\" euler=\"{degrees} 0 0\" {geom}/>\
         </body></body></worldbody></mujoco>"
    )
}

fn urdf(shape: &str, roll: &str) -> String {
    format!(
        "<robot name=\"r\"><link name=\"base\"/><link name=\"foot\"><collision>\
         <origin xyz=\"0 0 0.05\" rpy=\"{roll} 0 0\"/><geometry>{shape}</geometry>\
         </collision></link>\
         <joint name=\"hip\" type=\"revolute\"><origin xyz=\"0.1 0.2 1\"/><axis xyz=\"0 1 0\"/>\
         <limit effort=\"1\" velocity=\"1\" lower=\"-1\" upper=\"1\"/>\
         <parent link=\"base\"/><child link=\"foot\"/></joint></robot>"
    )
}

/// All points are where a solid reaches this far down from its centre.
fn reach(found: &[f64], count: usize, depth: f64) {
    assert_eq!(found.len(), count);
    for height in found {
        assert!((height - (1.05 - depth)).abs() < 1e-14, "{found:?}: {depth}");
    }
}

#[test]
fn round_solids_touch_with_their_lowest_points() {
    for degrees in [0.0, 25.0, 70.0, 115.0, 205.0_f64] {
        // free fall in the geom's frame is (0, s, c), but for its sign
        let (s, c) = degrees.to_radians().sin_cos();
        reach(&heights(&mjcf("type=\"sphere\" size=\"0.03\"", degrees)), 1, 0.03);
        let ellipsoid = (0.02_f64 * s).hypot(0.04 * c);
        reach(&heights(&mjcf("type=\"ellipsoid\" size=\"0.1 0.02 0.04\"", degrees)), 1, ellipsoid);
        let ends = heights(&mjcf("type=\"capsule\" size=\"0.03 0.2\"", degrees));
        let lowest = ends.iter().copied().fold(f64::INFINITY, f64::min);
        reach(&[lowest], 1, 0.03 + 0.2 * c.abs());
        // one that stands touches with one end
        assert_eq!(ends.len(), if c.abs() > s.abs() { 1 } else { 2 });
    }
}

#[test]
fn faces_and_edges_that_lie_flat_touch_with_their_corners() {
    let cylinder = "type=\"cylinder\" size=\"0.03 0.2\"";
    reach(&heights(&mjcf(cylinder, 0.0)), 4, 0.2);
    reach(&heights(&mjcf(cylinder, 180.0)), 4, 0.2);
    reach(&heights(&mjcf(cylinder, 90.0)), 2, 0.03);
    reach(&heights(&mjcf("type=\"capsule\" size=\"0.03 0.2\"", 90.0)), 2, 0.03);
    reach(&heights(&mjcf("type=\"box\" size=\"0.1 0.02 0.04\"", 0.0)), 4, 0.04);
    reach(&heights(&mjcf("type=\"box\" size=\"0.1 0.02 0.04\"", -90.0)), 4, 0.02);
    reach(&heights(&urdf("<cylinder radius=\"0.03\" length=\"0.4\"/>", "0")), 4, 0.2);
    reach(
        &heights(&urdf("<cylinder radius=\"0.03\" length=\"0.4\"/>", "1.5707963267948966")),
        2,
        0.03,
    );
    reach(&heights(&urdf("<box size=\"0.2 0.04 0.08\"/>", "0")), 4, 0.04);
}

#[test]
fn a_foot_without_a_solid_that_touches_is_refused() {
    let said = |text: &str| {
        let options = Options { contacts: vec!["foot".to_owned()], ..Options::default() };
        let refused = import("r.xml", text.as_bytes(), &options, &mut nothing_included);
        refused.expect_err("nothing touches").to_string()
    };
    let picture = mjcf("type=\"sphere\" size=\"0.03\" contype=\"0\" conaffinity=\"0\"", 0.0);
    assert!(said(&picture).contains("no geom that touches"), "{}", said(&picture));
    let negative = said(&urdf("<cylinder radius=\"-1\" length=\"0.4\"/>", "0"));
    assert!(negative.contains("`radius`") && !negative.contains("no collision"), "{negative}");
    let nowhere = said(&mjcf("type=\"sphere\" size=\"0.03\"", 0.0).replace("name=\"foot\"", ""));
    assert!(nowhere.contains("no body is called `foot`"), "{nowhere}");
}
