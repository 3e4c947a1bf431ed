//! What is said of descriptions that are wrong: all at once, each with place, cause and hint.

use denavit_import::{Beside, Options, import, is_description, nothing_included};

fn said(text: &str) -> String {
    let refused = import("r.urdf", text.as_bytes(), &Options::default(), &mut nothing_included);
    refused.expect_err("a fault").to_string()
}

#[test]
fn all_faults_of_a_file_are_reported_with_their_places() {
    let text = "<robot name=\"r\">\n\
                <link name=\"a\"><inertial><mass value=\"heavy\"/></inertial></link>\n\
                <link name=\"b\"/>\n\
                <joint name=\"j\" type=\"revolut\">\n\
                <origin xyz=\"0 0\" rpy=\"0 0 ${pi}\"/>\n\
                <parent link=\"a\"/><child link=\"b\"/></joint>\n\
                <xacro:arm side=\"left\"/>\n</robot>";
    let said = said(text);
    for part in [
        "r.urdf:2:39: the mass is a number, not \"heavy\"",
        "r.urdf:4:",
        "no joint has the type \"revolut\"",
        "r.urdf:5:14: `xyz` is 3 numbers, not \"0 0\"",
        "r.urdf:7:1: <xacro:arm> has not been expanded",
        "hint: run `xacro",
    ] {
        assert!(said.contains(part), "{part} in:\n{said}");
    }
}

#[test]
fn trees_are_trees() {
    let joint = |name: &str, parent: &str, child: &str| {
        format!(
            "<joint name=\"{name}\" type=\"fixed\"><parent link=\"{parent}\"/>\
             <child link=\"{child}\"/></joint>"
        )
    };
    let links = "<link name=\"a\"/><link name=\"b\"/><link name=\"c\"/>";
    let robot = |joints: &str| format!("<robot name=\"r\">{links}{joints}</robot>");
    let cases = [
        (robot(&joint("j", "a", "b")), "carried by no joint: `a`, `c`"),
        (robot(&(joint("j", "a", "b") + &joint("k", "c", "b"))), "already carried by joint `j`"),
        (robot(&joint("j", "a", "bb")), "no link is called `bb`"),
        (
            robot(&(joint("j", "b", "c") + &joint("k", "c", "b"))),
            "these links carry each other: `b`, `c`",
        ),
        (robot(&(joint("j", "a", "b") + &joint("j", "b", "c"))), "two joints are called `j`"),
        ("<robot name=\"r\"/>".to_owned(), "the robot has no link"),
        ("<robot name=\"r\"><link name=\"a\"/></robot>".to_owned(), "options.base=floating"),
        ("<sdf/>".to_owned(), "neither <robot>"),
    ];
    for (text, part) in cases {
        let said = said(&text);
        assert!(said.contains(part), "{part} in:\n{said}");
    }
}

#[test]
fn impossible_bodies_are_refused_as_model_files_refuse_them() {
    let text = "<robot name=\"r\"><link name=\"a\"/><link name=\"b\"><inertial><mass value=\"1\"/>\
                <inertia ixx=\"1\" iyy=\"-1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\
                </inertial></link>\
                <joint name=\"j\" type=\"continuous\"><parent link=\"a\"/>\
                <child link=\"b\"/></joint></robot>";
    let found = said(text);
    assert!(found.contains("link `b`: about the centre of mass, Iyy = -1 is negative"), "{found}");
    // moments that no body has, with positive energies, are kept and said to be
    let text = text.replace("iyy=\"-1\"", "iyy=\"3\"");
    let kept = import("r.urdf", text.as_bytes(), &Options::default(), &mut nothing_included);
    let kept = kept.expect("kept");
    assert!(kept.model.contains("accept_triangle_violation") && kept.notes[0].contains("`b`"));
}

#[test]
fn descriptions_are_known_by_their_first_character() {
    assert!(is_description(b"\n <robot/>") && is_description(b"\xef\xbb\xbf<?xml?>"));
    assert!(!is_description(b"{\"format\": 1}") && !is_description(b""));
}

#[test]
fn files_that_include_themselves_end() {
    let text = "<mujoco><worldbody><body><joint/><geom size=\"1\"/><include file=\"a.xml\"/></body>\
                </worldbody></mujoco>";
    let again = "<mujoco><body><include file=\"a.xml\"/><include file=\"a.xml\"/></body></mujoco>";
    let mut include = |_: Beside<'_>| Ok(again.as_bytes().to_vec());
    let refused = import("a.xml", text.as_bytes(), &Options::default(), &mut include);
    assert!(refused.expect_err("a fault").to_string().contains("included twice"));
}

#[test]
fn nothing_is_expanded() {
    let bomb = "<!DOCTYPE r [<!ENTITY a \"aaaa\"><!ENTITY b \"&a;&a;\">]><robot name=\"&b;\"/>";
    assert!(said(bomb).contains("document type"));
    let include = "<mujoco><include file=\"/etc/passwd\"/></mujoco>";
    assert!(said(include).contains("not included"));
}
