//! The page of a run: what is played back is what the run did.

use denavit_report::answer::{ShownWithRun, run_page};
use denavit_workflow::Files;
use serde_json::Value;
use std::path::Path;

/// The data of the replay on the page of a shipped scenario, and the page.
fn replayed(name: &str) -> (Value, String) {
    let mut scenario = Files::default().scenario(Path::new(name)).unwrap();
    let run = scenario.run().unwrap();
    let broken = scenario.broken(&run);
    let page = run_page(&mut scenario, &run, &broken, ShownWithRun::default(), "0").render();
    let (_, figure) = page.split_once("<figure class=\"scene\">").expect("a replay");
    let (_, data) = figure.split_once("<script type=\"application/json\">").expect("data");
    let (data, _) = data.split_once("</script>").expect("their end");
    (serde_json::from_str(data).expect("JSON"), page)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().expect("a list").iter().map(|one| one.as_f64().unwrap_or(f64::NAN)).collect()
}

#[test]
fn a_biped_is_played_back_with_its_balance() {
    let (data, page) = replayed("planar_biped_start_stop");
    let frames = numbers(&data["t"]).len();
    let links = data["links"].as_array().unwrap().len();
    assert!((200..=1600).contains(&frames), "{frames}");
    let poses = numbers(&data["poses"]);
    assert_eq!(poses.len(), 7 * links * frames);
    for pose in poses.chunks_exact(7) {
        let length: f64 = pose[3..].iter().map(|part| part * part).sum();
        assert!((length - 1.0).abs() < 1e-3, "a turn: {pose:?}");
    }
    for (points, each) in [("com", 3), ("zmp", 3), ("capture", 3), ("forces", 3 * 4)] {
        assert_eq!(numbers(&data[points]).len(), each * frames, "{points}");
    }
    // it starts at rest: the capture point is below the centre of mass
    let [com, capture] = ["com", "capture"].map(|name| numbers(&data[name]));
    assert!((com[0] - capture[0]).abs() < 1e-4, "{} {}", com[0], capture[0]);
    assert!(
        page.contains("every law that is audited holds") && page.contains("touches the ground")
    );
    assert_eq!(page, replayed("planar_biped_start_stop").1, "the same bytes");
}

#[test]
fn what_stands_on_nothing_has_no_balance() {
    let (data, page) = replayed("double_pendulum");
    assert!(data["zmp"].is_null() && data["ground"].is_null());
    assert!(!page.contains("zero moment point</label>"), "no mark of it");
}
