//! `limpid bench`: a case is measured, reported and plotted.

mod common;

use common::Folder;

const SMALL: [&str; 7] = ["bench", "--particles", "300,2000", "--size", "96x64", "--runs", "2"];

#[test]
fn every_case_is_in_the_table_the_json_and_the_plot() {
    let folder = Folder::new();
    let arguments = [&SMALL[..], &["--filter", "none,narrow-range", "--json", "a.json", "--plot", "a.svg"]].concat();
    let table = folder.succeed(&arguments);
    let report: serde_json::Value = serde_json::from_slice(&folder.bytes("a.json")).unwrap();
    assert!(report["copy_bandwidth"].as_f64().unwrap() > 0.0);
    let cases = report["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 2 * 2 * 2);
    for case in cases {
        assert_eq!(case["size"], serde_json::json!([96, 64]));
        assert_eq!(case["wall_ms"]["runs"], 2);
        assert!(case["wall_ms"]["min"].as_f64() <= case["wall_ms"]["median"].as_f64());
        let filter = case["filter"].as_str().unwrap();
        let particles = case["particles"].to_string();
        let line = table.lines().find(|line| line.contains(&particles) && line.contains(filter));
        assert!(line.is_some(), "{table}");
        let names: Vec<_> =
            case["passes"].as_array().unwrap().iter().map(|pass| pass["name"].as_str().unwrap()).collect();
        // None where the adapter has no clock.
        if !names.is_empty() {
            assert_eq!(names.iter().any(|name| name.starts_with("smooth/narrow-range")), filter == "narrow-range");
            assert!(names.contains(&"splat-depth") && names.contains(&"composite"), "{names:?}");
        }
    }
    let plot = String::from_utf8(folder.bytes("a.svg")).unwrap();
    let plot = roxmltree::Document::parse(&plot).unwrap();
    let lines = plot.descendants().filter(|node| node.has_tag_name("polyline"));
    let points: Vec<usize> = lines.map(|line| line.attribute("points").unwrap().split(' ').count()).collect();
    assert_eq!(points, [2; 4]);
}

#[test]
fn what_cannot_be_measured_is_told() {
    let folder = Folder::new();
    let (_, told) = folder.fail(&["bench", "--particles", "0"]);
    assert!(told.contains("--particles"), "{told}");
    let (_, told) = folder.fail(&["bench", "--quick", "--json", "nowhere/a.json"]);
    assert!(told.contains("there is no folder nowhere"), "{told}");
    let (_, told) = folder.fail(&["bench", "--filter", "median"]);
    assert!(told.contains("narrow-range"), "{told}");
}
