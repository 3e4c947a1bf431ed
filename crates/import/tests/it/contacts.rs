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
    // one that leans: the lowest point of its rim is one of the four
    let leaning = heights(&urdf("<cylinder radius=\"0.03\" length=\"0.4\"/>", "0.3"));
    let lowest = leaning.iter().copied().fold(f64::INFINITY, f64::min);
    reach(&[lowest], 1, 0.2 * 0.3_f64.cos() + 0.03 * 0.3_f64.sin());
    assert_eq!(leaning.len(), 4);
    // a joint whose variable is a quarter turn where the file shows it, lies on another face at 0
    let turned = mjcf("type=\"box\" size=\"0.1 0.02 0.04\"", 0.0)
        .replace("name=\"hip\"", "name=\"hip\" ref=\"90\"");
    let turned = heights(&turned);
    assert!(turned.iter().all(|height| (height - turned[0]).abs() < 1e-14), "{turned:?}");
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
    let without_length = said(&urdf("<cylinder radius=\"1\"/>", "0"));
    assert!(without_length.contains("has no `length`"), "{without_length}");
    let inside_out = said(&urdf("<box size=\"-1 1 1\"/>", "0"));
    assert!(inside_out.contains("`size`") && !inside_out.contains("meshes"), "{inside_out}");
    let ball = mjcf("type=\"sphere\" size=\"0.03\"", 0.0);
    let weightless = ball.replace("<worldbody>", "<option gravity=\"0 0 0\"/><worldbody>");
    assert!(said(&weightless).contains("without gravity"), "{}", said(&weightless));
    let twice = ball.replace("name=\"leg\"", "name=\"foot\"");
    assert!(said(&twice).contains("two bodies are called `foot`"), "{}", said(&twice));
    let contacts = vec!["foot".to_owned(), "foot".to_owned()];
    let cut = Options { contacts, tip: Some("leg".to_owned()), ..Options::default() };
    let jointed = ball.replace("<geom pos", "<joint name=\"ankle\"/><geom pos");
    let cut = import("r.xml", jointed.as_bytes(), &cut, &mut nothing_included).expect_err("cut");
    assert!(cut.to_string().contains("leaves out what these points are on"), "{cut}");
    let negative = said(&urdf("<cylinder radius=\"-1\" length=\"0.4\"/>", "0"));
    assert!(negative.contains("`radius`") && !negative.contains("no collision"), "{negative}");
    let nowhere = said(&mjcf("type=\"sphere\" size=\"0.03\"", 0.0).replace("name=\"foot\"", ""));
    assert!(nowhere.contains("no body is called `foot`"), "{nowhere}");
}
