//! Contact points of meshes against those of the solids that they are made of, and areas in
//! closed form.

use crate::evaluated::{Random, called};
use denavit_codegen::function::FunctionName;
use denavit_import::{Beside, Error, Imported, Options, import};
use std::fmt::Write;

/// A leg with a foot one metre up.
fn urdf(geometry: &str) -> String {
    format!(
        "<robot name=\"r\"><link name=\"base\"/><link name=\"foot\"><collision>\
         <origin xyz=\"0.01 0 0.05\" rpy=\"0.3 0 0\"/><geometry>{geometry}</geometry>\
         </collision></link>\
         <joint name=\"hip\" type=\"revolute\"><origin xyz=\"0.1 0.2 1\"/><axis xyz=\"0 1 0\"/>\
         <limit effort=\"1\" velocity=\"1\" lower=\"-1\" upper=\"1\"/>\
         <parent link=\"base\"/><child link=\"foot\"/></joint></robot>"
    )
}

fn read(text: &str, bytes: &[u8]) -> Result<Imported, Error> {
    let options = Options { contacts: vec!["foot".to_owned()], ..Options::default() };
    let mut include = |named: Beside<'_>| match named {
        Beside::Mesh("package://r/sole.stl" | "parts/sole.obj") => Ok(bytes.to_vec()),
        Beside::Mesh(name) | Beside::Description(name) => Err(format!("asked for {name}")),
    };
    import("r", text.as_bytes(), &options, &mut include)
}

/// World positions of the contact points, with all joints at 0, from the lowest x on.
fn points(found: &Imported) -> Vec<[f64; 3]> {
    let robot = denavit_codegen::model::read("r.json", found.model.as_bytes()).expect("a model");
    let all = called(&robot, FunctionName::ContactPositions, &[&[0.0]]);
    let mut points: Vec<[f64; 3]> = all.as_chunks().0.to_vec();
    points.sort_by(|a, b| a.partial_cmp(b).expect("numbers"));
    points
}

type Triangle = [[f32; 3]; 3];

/// A block of these half edges.
fn block(half: [f32; 3]) -> Vec<Triangle> {
    let corner = |at: usize| -> [f32; 3] {
        std::array::from_fn(|k| if at >> k & 1 == 0 { -half[k] } else { half[k] })
    };
    let faces =
        [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let halves = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]);
    halves.map(|corners| corners.map(corner)).collect()
}

/// A disc of so many corners, and a point above it.
fn cone(count: u32, radius: f64, height: f32) -> Vec<Triangle> {
    let rim = |at: u32| {
        let angle = f64::from(at) / f64::from(count) * std::f64::consts::TAU;
        [(radius * angle.cos()) as f32, (radius * angle.sin()) as f32, 0.0]
    };
    (0..count).map(|at| [rim(at), rim(at + 1), [0.0, 0.0, height]]).collect()
}

fn binary(triangles: &[Triangle]) -> Vec<u8> {
    let mut bytes = vec![b's'; 80];
    bytes.extend(u32::try_from(triangles.len()).expect("few").to_le_bytes());
    for triangle in triangles {
        let numbers = [0.0; 3].into_iter().chain(triangle.iter().flatten().copied());
        bytes.extend(numbers.flat_map(f32::to_le_bytes));
        bytes.extend([0, 0]);
    }
    bytes
}

fn written(triangles: &[Triangle]) -> Vec<u8> {
    let mut text = "solid foot\n".to_owned();
    for triangle in triangles {
        text += "facet normal 0 0 0\nouter loop\n";
        for [x, y, z] in triangle {
            writeln!(text, "  vertex {x:e} {y:e} {z:e}").expect("a string");
        }
        text += "endloop\nendfacet\n";
    }
    text.into_bytes()
}

fn wavefront(triangles: &[Triangle]) -> Vec<u8> {
    let corners = triangles.iter().flatten();
    corners.map(|[x, y, z]| format!("v {x} {y} {z} 1.0\n")).collect::<String>().into_bytes()
}

const STL: &str = "<mesh filename=\"package://r/sole.stl\"/>";
const OBJ: &str = "<mesh filename=\"parts/sole.obj\"/>";

#[test]
fn a_block_as_a_mesh_of_any_format_has_the_points_of_the_box() {
    let flat = |text: String| text.replace("rpy=\"0.3 0 0\"", "rpy=\"0 0 0.3\"");
    let solid = read(&flat(urdf("<box size=\"0.2 0.08 0.03\"/>")), b"").expect("a box");
    let triangles = block([0.1, 0.04, 0.015]);
    for (mesh, bytes) in
        [(STL, binary(&triangles)), (STL, written(&triangles)), (OBJ, wavefront(&triangles))]
    {
        let found = read(&flat(urdf(mesh)), &bytes).expect("a mesh");
        assert_eq!(points(&found), points(&solid));
        assert!(
            found.notes.iter().any(|note| note.contains("4 corners") && note.contains("100 %"))
        );
        // 0.095 was meant, and not 0.0949999988079071
        assert!(!found.model.contains("0.09999999"), "{}", found.model);
        // one that leans stands on an edge
        let edge = points(&read(&urdf(mesh), &bytes).expect("an edge"));
        assert_eq!(edge.len(), 2, "{edge:?}");
        let (sine, cosine) = 0.3_f64.sin_cos();
        let lowest = 1.05 - 0.04 * sine - 0.015 * cosine;
        assert!(edge.iter().all(|at| (at[2] - lowest).abs() < 1e-14), "{edge:?}: {lowest}");
    }
}

#[test]
fn a_round_sole_keeps_four_corners_and_says_what_they_cover() {
    let text = urdf(STL).replace("rpy=\"0.3 0 0\"", "rpy=\"0 0 0\"");
    let found = read(&text, &binary(&cone(32, 0.05, 0.1))).expect("a cone");
    let corners = points(&found);
    assert_eq!(corners.len(), 4);
    for [x, y, z] in &corners {
        assert!(((x - 0.11).hypot(y - 0.2) - 0.05).abs() < 1e-8 && (z - 1.05).abs() < 1e-14);
    }
    // the square in the polygon of 32 corners
    let share = 2.0 / (16.0 * (std::f64::consts::TAU / 32.0).sin());
    let said = found.notes.iter().find(|note| note.contains("sole.stl")).expect("a note");
    assert!(said.contains(&format!("with {:.0} % of the area", share * 100.0)), "{said}");
    assert!(said.contains("within 1 mm"), "{said}");
}

#[test]
fn scales_and_frames_of_mjcf_move_a_mesh() {
    let text = "<mujoco><compiler meshdir=\"parts/\"/>\
        <default><default class=\"mm\"><mesh scale=\"0.001 0.001 0.002\"/></default></default>\
        <asset><mesh class=\"mm\" file=\"sole.obj\"/></asset>\
        <worldbody><body name=\"leg\"><joint name=\"hip\" axis=\"0 1 0\"/>\
        <inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>\
        <body name=\"foot\" pos=\"0 0 1\">\
        <inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 1 1\"/>\
        <frame pos=\"0.5 0 0\" euler=\"0 0 90\">\
        <geom type=\"mesh\" mesh=\"sole\" pos=\"0 0.25 0\" mass=\"0\"/></frame>\
        </body></body></worldbody></mujoco>";
    let found = points(&read(text, &wavefront(&block([100.0, 50.0, 10.0]))).expect("a mesh"));
    // y of the frame is -x of the foot
    let expected = [[0.2, -0.1], [0.2, 0.1], [0.3, -0.1], [0.3, 0.1]].map(|[x, y]| [x, y, 0.98]);
    for (found, expected) in found.iter().zip(expected) {
        let near = found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-14);
        assert!(near, "{found:?}: {expected:?}");
    }
    assert_eq!(found.len(), 4);
}

#[test]
fn meshes_that_say_nothing_are_refused_with_the_reason() {
    let said = |mesh: &str, bytes: &[u8]| match read(&urdf(mesh), bytes) {
        Ok(found) => panic!("{}", found.model),
        Err(refused) => refused.to_string(),
    };
    let whole = binary(&block([0.1, 0.04, 0.015]));
    let cut = said(STL, &whole[..whole.len() - 1]);
    assert!(cut.contains("it is cut") && cut.contains("12 triangles"), "{cut}");
    let mut endless = whole.clone();
    endless[84 + 12..84 + 16].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(said(STL, &endless).contains("not finite"));
    assert!(said(STL, &[]).contains("no STL"));
    assert!(said(STL, &binary(&[])).contains("no corner"));
    assert!(said(OBJ, b"v 1 2").contains("line 1"));
    assert!(said(OBJ, b"v 1 2 nan").contains("line 1"));
    assert!(said(OBJ, b"f 1 2 3").contains("no corner"));
    assert!(said("<mesh filename=\"a.dae\"/>", b"").contains("asked for a.dae"));
    assert!(said("<mesh scale=\"1 1 1\"/>", b"").contains("`filename`"));
    assert!(said(&STL.replace("/>", " scale=\"2\"/>"), &whole).contains("`scale`"));
}

#[test]
fn no_mutation_of_a_mesh_is_more_than_a_fault() {
    let mut random = Random(31);
    let triangles = block([0.1, 0.04, 0.015]);
    let seeds =
        [(STL, binary(&triangles)), (STL, written(&triangles)), (OBJ, wavefront(&triangles))];
    let (mut accepted, mut refused) = (0, 0);
    for (mesh, seed) in seeds {
        for _ in 0..600 {
            let mut bytes = seed.clone();
            for _ in 0..=random.whole(3) {
                let at = random.whole(bytes.len() as u64) as usize;
                match random.whole(4) {
                    0 => bytes[at] = random.whole(256) as u8,
                    1 => bytes[at] = b"0123456789e-+. \nv"[random.whole(17) as usize],
                    2 => bytes.truncate(at.max(1)),
                    _ => drop(bytes.splice(at..at, *b"1e999")),
                }
            }
            match read(&urdf(mesh), &bytes) {
                Ok(_) => accepted += 1,
                Err(error) => {
                    assert!(!error.to_string().is_empty());
                    refused += 1;
                }
            }
        }
    }
    assert!(accepted > 100 && refused > 100, "{accepted} accepted, {refused} refused");
}
