//! The 2022 paper's Fig. 9: the time of a frame against the number of particles, as an SVG picture.

use crate::report::{Measurement, Report};
use limpid::Filter;
use std::fmt::Write;

const SIZE: [f64; 2] = [770.0, 460.0];
/// Left, top, right, bottom of the axes.
const BOX: [f64; 4] = [70.0, 30.0, 540.0, 400.0];
/// The paper's largest set: beyond it the plot ends.
const MOST_PARTICLES: usize = 4_200_000;

/// Told apart by people who see few colours, too (Okabe and Ito).
fn color(filter: Filter) -> &'static str {
    match filter {
        Filter::None => "#888888",
        Filter::Gaussian => "#e69f00",
        Filter::Bilateral => "#56b4e9",
        Filter::CurvatureFlow => "#009e73",
        Filter::NarrowRange => "#d55e00",
        _ => "#000000",
    }
}

/// Powers of ten on one axis.
struct Axis {
    decades: [i32; 2],
    ends: [f64; 2],
}

impl Axis {
    fn new(values: impl Iterator<Item = f64>, ends: [f64; 2]) -> Self {
        let logs: Vec<f64> = values.filter(|value| *value > 0.0).map(f64::log10).collect();
        let low = logs.iter().copied().fold(f64::INFINITY, f64::min).floor() as i32;
        let high = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil() as i32;
        Self { decades: [low, high.max(low + 1)], ends }
    }

    fn at(&self, value: f64) -> f64 {
        let [low, high] = self.decades.map(f64::from);
        let part = (value.max(1e-9).log10() - low) / (high - low);
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }
}

/// Of the first size that was measured, each filter with anisotropy off (whole lines) and on (dashed); None where there is nothing to
/// plot.
pub fn fig9(report: &Report) -> Option<String> {
    let size = report.cases.first()?.size;
    let cases: Vec<&Measurement> =
        report.cases.iter().filter(|case| case.size == size && case.particles <= MOST_PARTICLES).collect();
    if cases.is_empty() {
        return None;
    }
    let [left, top, right, bottom] = BOX;
    let x = Axis::new(cases.iter().map(|case| case.particles as f64), [left, right]);
    let y = Axis::new(cases.iter().map(|case| case.frame_ms().median), [bottom, top]);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n",
        SIZE[0], SIZE[1]
    );
    draw_axes(&mut svg, &x, &y);
    let title = format!("{}, {} x {}", escaped(&report.adapter), size[0], size[1]);
    let _ = writeln!(svg, "<text x=\"{left}\" y=\"{}\">{title}</text>", top - 12.0);
    let mut series: Vec<(Filter, bool)> = cases.iter().map(|case| (case.filter, case.anisotropy)).collect();
    series.sort_by_key(|(filter, anisotropy)| (filter.name(), *anisotropy));
    series.dedup();
    for (index, (filter, anisotropy)) in series.into_iter().enumerate() {
        let mut points: Vec<&&Measurement> =
            cases.iter().filter(|case| case.filter == filter && case.anisotropy == anisotropy).collect();
        points.sort_by_key(|case| case.particles);
        let dash = if anisotropy { " stroke-dasharray=\"6 4\"" } else { "" };
        let stroke = format!("stroke=\"{}\" fill=\"none\" stroke-width=\"2\"{dash}", color(filter));
        let path: Vec<String> = points
            .iter()
            .map(|case| format!("{:.1},{:.1}", x.at(case.particles as f64), y.at(case.frame_ms().median)))
            .collect();
        let _ = writeln!(svg, "<polyline points=\"{}\" {stroke}/>", path.join(" "));
        for case in points {
            // The middle half of the frames.
            let at = x.at(case.particles as f64);
            let [low, high] = [case.frame_ms().low, case.frame_ms().high].map(|ms| y.at(ms));
            let _ = writeln!(svg, "<path d=\"M{at:.1} {low:.1}V{high:.1}\" stroke=\"{}\"/>", color(filter));
            let middle = y.at(case.frame_ms().median);
            let _ = writeln!(svg, "<circle cx=\"{at:.1}\" cy=\"{middle:.1}\" r=\"3\" fill=\"{}\"/>", color(filter));
        }
        let line = top + 10.0 + 20.0 * index as f64;
        let name = format!("{}{}", filter.name(), if anisotropy { ", anisotropic" } else { "" });
        let _ = writeln!(svg, "<path d=\"M{} {line}h24\" {stroke}/>", right + 14.0);
        let _ = writeln!(svg, "<text x=\"{}\" y=\"{}\">{name}</text>", right + 44.0, line + 4.0);
    }
    svg.push_str("</svg>\n");
    Some(svg)
}

fn draw_axes(svg: &mut String, x: &Axis, y: &Axis) {
    let [left, top, right, bottom] = BOX;
    let grid = "stroke=\"#dddddd\"";
    for decade in x.decades[0]..=x.decades[1] {
        let at = x.at(10f64.powi(decade));
        let _ = writeln!(svg, "<path d=\"M{at:.1} {top}V{bottom}\" {grid}/>");
        let _ = writeln!(
            svg,
            "<text x=\"{at:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
            bottom + 18.0,
            count(decade)
        );
    }
    for decade in y.decades[0]..=y.decades[1] {
        let at = y.at(10f64.powi(decade));
        let _ = writeln!(svg, "<path d=\"M{left} {at:.1}H{right}\" {grid}/>");
        let _ = writeln!(
            svg,
            "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{} ms</text>",
            left - 6.0,
            at + 4.0,
            10f64.powi(decade)
        );
    }
    let _ = writeln!(
        svg,
        "<rect x=\"{left}\" y=\"{top}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"black\"/>",
        right - left,
        bottom - top
    );
    let middle = 0.5 * (left + right);
    let _ = writeln!(svg, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">particles</text>", bottom + 40.0);
}

/// A power of ten as people say it.
fn count(decade: i32) -> String {
    match decade {
        ..3 => 10f64.powi(decade).to_string(),
        3..6 => format!("{} k", 10f64.powi(decade - 3)),
        _ => format!("{} M", 10f64.powi(decade - 6)),
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}
