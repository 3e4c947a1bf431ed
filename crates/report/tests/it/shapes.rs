//! Shapes of links stand where the URDF or the MJCF has them: against a chain of frames that is
//! computed here.

use denavit_report::inspection_page;
use denavit_workflow::{Files, RobotFile};
use serde_json::Value;
use std::fs;
use std::path::Path;

type Point = [f64; 3];

const ARM: &str = r#"<robot name="arm">
  <link name="stand"><visual><origin xyz="0 0 0.1"/><geometry><box size="0.2 0.2 0.2"/>
  </geometry></visual></link>
  <link name="upper"><inertial><mass value="2"/><inertia ixx="0.01" iyy="0.01" izz="0.01"
    ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><origin xyz="0.01 0.02 0.03" rpy="0.4 -0.3 1.1"/><geometry>
      <mesh filename="package://arm/meshes/wedge.STL" scale="0.001 0.001 0.002"/>
      </geometry></visual>
  </link>
  <link name="fore"><inertial><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01"
    ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><mesh filename="meshes/wedge.STL"/></geometry></collision></link>
  <joint name="shoulder" type="revolute"><origin xyz="0 0.1 0.4" rpy="0.2 0 -0.7"/>
    <axis xyz="0 1 0"/><parent link="stand"/><child link="upper"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0.3 0.05 0" rpy="0 1.2 0.5"/>
    <axis xyz="1 0 0"/><parent link="upper"/><child link="fore"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/></joint>
</robot>"#;

/// In the units of its file.
const WEDGE: [Point; 4] = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 50.0, 0.0], [0.0, 0.0, 25.0]];

fn wedge(factor: f64) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(4u32.to_le_bytes());
    for skipped in 0..4 {
        bytes.extend([0; 12]);
        for (_, corner) in WEDGE.iter().enumerate().filter(|(at, _)| *at != skipped) {
            bytes.extend(corner.iter().flat_map(|x| ((factor * x) as f32).to_le_bytes()));
        }
        bytes.extend([0; 2]);
    }
    bytes
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("meshes")).expect("a folder");
    fs::write(folder.path().join("meshes/wedge.STL"), wedge(1.0)).expect("a mesh");
    fs::write(folder.path().join("arm.urdf"), ARM).expect("a file");
    folder
}

/// What the page of a model draws, and the page.
fn page(model: &Path) -> (Value, String) {
    let robot = RobotFile::open(model).expect("a robot").whole;
    let shapes = Files::default().shapes_of(model, None, None).expect("shapes");
    let page = inspection_page(&robot, "0", shapes.as_ref()).expect("a page").render();
    let (_, figure) = page.split_once("<figure class=\"scene\">").expect("a scene");
    let (_, data) = figure.split_once("<script type=\"application/json\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("their end");
    (serde_json::from_str(data).expect("JSON"), page)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|one| one.as_f64().expect("a number")).collect()
}

fn bytes(text: &str) -> Vec<u8> {
    let value = |letter: u8| match letter {
        b'A'..=b'Z' => u32::from(letter - b'A'),
        b'a'..=b'z' => u32::from(letter - b'a') + 26,
        b'0'..=b'9' => u32::from(letter - b'0') + 52,
        b'+' => 62,
        _ => 63,
    };
    let mut all = Vec::new();
    for four in text.as_bytes().chunks(4) {
        let kept = four.iter().filter(|&&letter| letter != b'=').count();
        let sum = four.iter().fold(0, |sum, &letter| sum << 6 | value(letter) & 63);
        all.extend(sum.to_be_bytes()[1..kept].iter());
    }
    all
}

/// A place and a turn as a quaternion (x, y, z, w).
type Pose = (Point, [f64; 4]);

fn turned([x, y, z, w]: [f64; 4], p: Point) -> Point {
    let [a, b, c] = p;
    let t = [2.0 * (y * c - z * b), 2.0 * (z * a - x * c), 2.0 * (x * b - y * a)];
    [
        a + w * t[0] + y * t[2] - z * t[1],
        b + w * t[1] + z * t[0] - x * t[2],
        c + w * t[2] + x * t[1] - y * t[0],
    ]
}

fn times([a, b, c, d]: [f64; 4], [x, y, z, w]: [f64; 4]) -> [f64; 4] {
    [
        d * x + a * w + b * z - c * y,
        d * y - a * z + b * w + c * x,
        d * z + a * y - b * x + c * w,
        d * w - a * x - b * y - c * z,
    ]
}

/// Corners of each shape in the world, by the numbers of the page with all joints at 0.
fn drawn(data: &Value) -> Vec<Vec<Point>> {
    let mut poses: Vec<Pose> = Vec::new();
    let base = ([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
    for link in data["links"].as_array().expect("links") {
        let carrier = usize::try_from(link["carrier"].as_i64().expect("a number"));
        let (at, turn) = carrier.map_or(base, |place| poses[place]);
        let zero = numbers(&link["zero"]);
        let moved = turned(turn, [zero[0], zero[1], zero[2]]);
        let at = [0, 1, 2].map(|k| at[k] + moved[k]);
        poses.push((at, times(turn, [zero[3], zero[4], zero[5], zero[6]])));
    }
    let shape = |shape: &Value| {
        let link = usize::try_from(shape["link"].as_i64().expect("a number"));
        let (at, turn) = link.map_or(base, |place| poses[place]);
        let [low, high] = ["low", "high"].map(|end| numbers(&shape[end]));
        let steps = bytes(shape["corners"].as_str().expect("text"));
        let steps: Vec<f64> =
            steps.chunks(2).map(|two| f64::from(u16::from_le_bytes([two[0], two[1]]))).collect();
        let corner = |three: &[f64]| {
            let own = [0, 1, 2].map(|k| low[k] + (high[k] - low[k]) * three[k] / 65535.0);
            let moved = turned(turn, own);
            [0, 1, 2].map(|k| at[k] + moved[k])
        };
        steps.chunks(3).map(corner).collect()
    };
    data["shapes"].as_array().expect("shapes").iter().map(shape).collect()
}

/// Fixed-axis roll, pitch and yaw, then a way: the product that the URDF's page defines.
fn placed([x, y, z]: Point, [roll, pitch, yaw]: Point, p: Point) -> Point {
    let about = |angle: f64, [a, b]: [f64; 2]| {
        [angle.cos() * a - angle.sin() * b, angle.sin() * a + angle.cos() * b]
    };
    let [b, c] = about(roll, [p[1], p[2]]);
    let [c, a] = about(pitch, [c, p[0]]);
    let [a, b] = about(yaw, [a, b]);
    [x + a, y + b, z + c]
}

fn shoulder(p: Point) -> Point {
    placed([0.0, 0.1, 0.4], [0.2, 0.0, -0.7], p)
}

fn near(found: &[Point], wanted: &[Point], within: f64) {
    assert_eq!(found.len(), wanted.len());
    for point in wanted {
        let apart = |other: &Point| (0..3).map(|k| (other[k] - point[k]).powi(2)).sum::<f64>();
        let least = found.iter().map(apart).fold(f64::INFINITY, f64::min).sqrt();
        assert!(least < within, "{point:?} is {least} m from {found:?}");
    }
}

#[test]
fn corners_of_meshes_stand_where_the_urdf_has_them() {
    let folder = folder();
    // of the forearm, whose mesh has no scale: metres
    fs::write(folder.path().join("meshes/wedge.STL"), wedge(0.01)).expect("a mesh");
    let (data, page) = page(&folder.path().join("arm.urdf"));
    let drawn = drawn(&data);
    assert_eq!(drawn.len(), 3);
    let block: Vec<Point> = (0..8)
        .map(|at| [0, 1, 2].map(|k| if at >> k & 1 == 0 { -0.1 } else { 0.1 }))
        .map(|[x, y, z]: Point| [x, y, z + 0.1])
        .collect();
    near(&drawn[0], &block, 1e-5);
    let upper = WEDGE.map(|[x, y, z]| {
        let own = [1e-5 * x, 1e-5 * y, 2e-5 * z];
        shoulder(placed([0.01, 0.02, 0.03], [0.4, -0.3, 1.1], own))
    });
    near(&drawn[1], &upper, 1e-6);
    let fore = WEDGE.map(|p| {
        let own = p.map(|entry| 0.01 * entry);
        shoulder(placed([0.3, 0.05, 0.0], [0.0, 1.2, 0.5], own))
    });
    near(&drawn[2], &fore, 1e-4);
    assert_eq!(data["shapes_whole"], true);
    assert!(page.contains("shapes of the links"));
}

/// The same arm, with what MuJoCo shows, what it does not, and solids that no URDF has.
const MJCF: &str = r#"<mujoco model="arm">
  <compiler angle="radian" eulerseq="XYZ" meshdir="meshes"/>
  <asset><mesh name="scaled" file="wedge.STL" scale="0.001 0.001 0.002"/><mesh file="wedge.STL"/>
    <mesh name="typed" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>
  <default><geom group="2"/><default class="hit"><geom group="3"/></default></default>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <geom type="box" pos="0 0 0.1" size="0.1 0.1 0.1"/>
    <body name="upper" pos="0 0.1 0.4" euler="0.2 0 -0.7">
      <inertial pos="0 0 0" mass="2" diaginertia="0.01 0.01 0.01"/>
      <joint name="shoulder" axis="0 1 0" range="-1 1"/>
      <geom type="mesh" mesh="scaled" pos="0.01 0.02 0.03" euler="0.4 -0.3 1.1"/>
      <geom class="hit" type="sphere" size="0.2"/>
      <geom type="sphere" size="0.3" rgba="1 0 0 0"/>
      <frame pos="0 0 0.1"><geom type="capsule" size="0.02" fromto="0 0 0 0.3 0 0"/></frame>
      <geom type="ellipsoid" size="0.1 0.2 0.3" pos="1 0 0"/>
      <geom type="mesh" mesh="typed"/>
      <body name="fore" pos="0.3 0.05 0" euler="0 1.2 0.5">
        <inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
        <joint name="elbow" axis="1 0 0" range="-1 1"/>
        <geom class="hit" type="mesh" mesh="wedge"/>
      </body>
    </body>
  </worldbody>
</mujoco>"#;

/// The lowest and the highest entries of each axis.
fn ends(points: impl Iterator<Item = Point> + Clone) -> [Point; 2] {
    [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| {
        [0, 1, 2].map(|k| points.clone().map(|point| point[k]).reduce(of).expect("points"))
    })
}

#[test]
fn geoms_stand_where_the_mjcf_has_them() {
    let folder = folder();
    fs::write(folder.path().join("meshes/wedge.STL"), wedge(0.01)).expect("a mesh");
    let (urdf, _) = page(&folder.path().join("arm.urdf"));
    let file = folder.path().join("arm.xml");
    fs::write(&file, MJCF).expect("a file");
    let (data, said) = page(&file);
    let (wanted, found) = (drawn(&urdf), drawn(&data));
    // the block of the world, the mesh of the upper arm, a capsule, an ellipsoid, the other mesh
    assert_eq!(found.len(), 5);
    for (own, other) in [(0, 0), (1, 1), (4, 2)] {
        near(&found[own], &wanted[other], 1e-4);
    }
    // back in the frame of the link, which turns about z, y and x
    let back = |p: &Point| {
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let origin = shoulder([0.0; 3]);
        axes.map(|axis: Point| {
            let along = shoulder(axis);
            (0..3).map(|k| (along[k] - origin[k]) * (p[k] - origin[k])).sum::<f64>()
        })
    };
    let solids = [
        (2, [[-0.02, -0.02, 0.08], [0.32, 0.02, 0.12]]),
        (3, [[0.9, -0.2, -0.3], [1.1, 0.2, 0.3]]),
    ];
    for (at, wanted) in solids {
        let [low, high] = ends(found[at].iter().map(back));
        near(&[low, high], &wanted, 2e-4);
    }
    assert!(
        said.contains(
            "body <code>upper</code> is not shown: the mesh <code>typed</code> has no file"
        )
    );
    assert_eq!(data["shapes_whole"], false);
}

#[test]
fn what_is_no_mesh_is_a_remark_and_the_rows_stay() {
    for (name, contents, said) in [
        ("meshes/wedge.STL", &wedge(1.0)[..200], "it is cut or no STL"),
        ("meshes/wedge.STL", &wedge(f64::NAN)[..], "not finite"),
        ("meshes/wedge.STL", &wedge(1.0)[..], "wants scale"),
    ] {
        let folder = folder();
        fs::write(folder.path().join(name), contents).expect("a mesh");
        if said == "wants scale" {
            // 100 is metres there
            let long = ARM.replace("scale=\"0.001 0.001 0.002\"", "scale=\"2 1 1\"");
            fs::write(folder.path().join("arm.urdf"), long).expect("a file");
        }
        let (data, page) = page(&folder.path().join("arm.urdf"));
        assert!(page.contains(said), "{said}");
        assert_eq!(data["shapes_whole"], false, "{said}");
    }
    let outside = ARM.replace("meshes/wedge.STL", "../wedge.dae");
    let folder = folder();
    fs::write(folder.path().join("arm.urdf"), outside).expect("a file");
    let (_, page) = page(&folder.path().join("arm.urdf"));
    assert!(page.contains("wedge.dae is not shown: it is not in"));
}
