//! The settings, made from what the options say of themselves: groups, ranges, units, choices, explanations.

use crate::book::Book;
use eframe::egui::{self, RichText, SliderClamping, Ui};
use limpid_shot::config::{self, About};
use limpid_shot::{Options, Range, look};
use toml::{Table, Value};

/// Options that are no settings of the picture, or have places of their own in the window.
const ELSEWHERE: [&str; 14] = [
    "liquid",
    "input",
    "output",
    "size",
    "camera-eye",
    "camera-target",
    "camera-up",
    "look",
    "show",
    "aov",
    "timings",
    "adapter",
    "quiet",
    "config",
];

/// The groups, as the pipeline is; those that are not listed come last.
const GROUPS: [&str; 7] = ["Surface", "Quality", "Living surface", "Droplets", "Look", "Scene", "Camera"];

/// The panel of settings.
pub struct Controls {
    about: Vec<About>,
    groups: Vec<String>,
    defaults: Table,
    filter: String,
}

impl Controls {
    /// Learns of all options.
    pub fn new() -> Self {
        let about: Vec<About> = config::about().into_iter().filter(|a| !ELSEWHERE.contains(&a.name.as_str())).collect();
        let mut groups: Vec<String> = GROUPS.map(String::from).to_vec();
        for a in &about {
            if !a.group.is_empty() && !groups.contains(&a.group) {
                groups.push(a.group.clone());
            }
        }
        Self {
            about,
            groups,
            defaults: Table::try_from(Options::defaults()).unwrap_or_default(),
            filter: String::new(),
        }
    }

    /// Draws the panel.
    ///
    /// # Errors
    /// A value that the options refuse.
    pub fn show(&mut self, ui: &mut Ui, book: &mut Book) -> Result<(), String> {
        let mut outcome = Ok(());
        ui.horizontal(|ui| {
            ui.label("Look");
            if let Some(change) = looks(ui, book) {
                outcome = change;
            }
            ui.add(
                egui::TextEdit::singleline(&mut self.filter).hint_text("find a setting").desired_width(f32::INFINITY),
            );
        });
        ui.add_space(4.0);
        let wanted = self.filter.to_lowercase();
        for group in &self.groups {
            let members: Vec<&About> = self
                .about
                .iter()
                .filter(|a| a.group == *group && (a.name.contains(&wanted) || a.help.to_lowercase().contains(&wanted)))
                .collect();
            if members.is_empty() {
                continue;
            }
            let open = (!wanted.is_empty()).then_some(true);
            let header = egui::CollapsingHeader::new(RichText::new(group.as_str()).strong())
                .open(open)
                .default_open(matches!(group.as_str(), "Surface" | "Look"));
            header.show(ui, |ui| {
                for about in members {
                    if let Err(problem) = self.option(ui, book, about) {
                        outcome = Err(problem);
                    }
                }
            });
        }
        outcome
    }

    /// A line: reset, name, value.
    fn option(&self, ui: &mut Ui, book: &mut Book, about: &About) -> Result<(), String> {
        let key = about.name.as_str();
        let (value, default) = (book.table().get(key).cloned(), self.defaults.get(key));
        let mut outcome = Ok(());
        ui.horizontal(|ui| {
            let is_changed = value.as_ref() != default;
            let reset = ui.add_enabled(is_changed, egui::Button::new("×").small().frame(false));
            if reset.on_hover_text(format!("Reset {key}")).clicked() {
                outcome = match default {
                    Some(default) => book.set(key, default.clone()).map_err(|error| error.to_string()),
                    None => {
                        book.remove(&[key]);
                        Ok(())
                    }
                };
                return;
            }
            let name = RichText::new(key.replace('-', " "));
            let width = (0.38 * ui.available_width()).max(90.0);
            ui.scope(|ui| {
                ui.set_width(width);
                let label = egui::Label::new(if is_changed { name.strong() } else { name }).truncate();
                ui.add(label).on_hover_text(&about.help);
            });
            let edited = match value {
                Some(value) => edit(ui, about, value, default),
                None => absent(ui, about, book),
            };
            if let Some(value) = edited {
                outcome = book.set(key, value).map_err(|error| error.to_string());
            }
        });
        outcome
    }
}

/// The looks that come with limpid.
fn looks(ui: &mut Ui, book: &mut Book) -> Option<Result<(), String>> {
    let now = book.options().look.clone().unwrap_or_else(|| "water".into());
    let mut chosen = None;
    egui::ComboBox::from_id_salt("look").selected_text(&now).width(90.0).show_ui(ui, |ui| {
        for (name, text) in look::NAMED {
            let about = text.lines().next().unwrap_or_default().trim_start_matches("# ");
            if ui.selectable_label(now == *name, *name).on_hover_text(about).clicked() {
                chosen = Some(*name);
            }
        }
    });
    chosen.map(|name| book.set("look", Value::String(name.into())).map_err(|error| error.to_string()))
}

/// What stands for an option that is chosen by the program.
fn absent(ui: &mut Ui, about: &About, book: &Book) -> Option<Value> {
    if !ui.button("auto").on_hover_text("Chosen by limpid; click to set it").clicked() {
        return None;
    }
    if let Some(first) = about.choices.first() {
        return Some(Value::String(first.clone()));
    }
    let triple = |v: [f64; 3]| Value::Array(v.map(Value::Float).to_vec());
    Some(match about.name.as_str() {
        "ortho" => Value::Float(2.0),
        "radius" => Value::Float(0.025),
        "sun-direction" => triple([0.4, 1.0, 0.3]),
        "absorption-per-world" => triple(book.options().absorption.unwrap_or([0.05; 3]).map(|a| 20.0 * a)),
        "absorption" => triple([0.045, 0.015, 0.0075]),
        "fov" => Value::Float(45.0),
        "range" => Value::Array(vec![Value::Float(0.0), Value::Float(1.0)]),
        name if Range::of(name).is_some() => Value::Float(1.0),
        "mesh" | "light" => Value::Array(vec![Value::String(String::new())]),
        _ => Value::String(String::new()),
    })
}

/// A widget for a value; what it has become, if that is something else.
fn edit(ui: &mut Ui, about: &About, value: Value, default: Option<&Value>) -> Option<Value> {
    let range = match Range::of(&about.name) {
        Some(Range::Within(least, most)) => (least, most),
        _ => (f64::MIN, f64::MAX),
    };
    if !about.choices.is_empty() && !value.is_bool() {
        return choice(ui, about, &value);
    }
    match value {
        Value::Boolean(mut on) => ui.checkbox(&mut on, "").changed().then_some(Value::Boolean(on)),
        Value::Float(number) => slider(ui, about, number, default, range, false).map(Value::Float),
        Value::Integer(number) => {
            slider(ui, about, number as f64, default, range, true).map(|number| Value::Integer(number as i64))
        }
        Value::Array(values) if values.iter().all(|value| !value.is_str()) => triple(ui, &values, range),
        Value::Array(values) => {
            let text = values.iter().filter_map(Value::as_str).collect::<Vec<_>>().join(" ");
            let edited = text_field(ui, &about.name, &text)?;
            Some(Value::Array(edited.split_whitespace().map(|word| Value::String(word.into())).collect()))
        }
        Value::String(text) => text_field(ui, &about.name, &text).map(Value::String),
        _ => None,
    }
}

fn choice(ui: &mut Ui, about: &About, value: &Value) -> Option<Value> {
    let now = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
    let mut chosen = None;
    let is_switch = about.choices.iter().all(|choice| choice == "on" || choice == "off");
    if is_switch {
        let mut on = now == "on";
        if ui.checkbox(&mut on, "").changed() {
            chosen = Some(if on { "on" } else { "off" }.to_owned());
        }
    } else {
        egui::ComboBox::from_id_salt(&about.name).selected_text(&now).show_ui(ui, |ui| {
            for choice in &about.choices {
                if ui.selectable_label(now == *choice, choice).clicked() {
                    chosen = Some(choice.clone());
                }
            }
        });
    }
    chosen.filter(|chosen| *chosen != now).map(Value::String)
}

/// A slider over the usual part of a range; the number beside it takes all of it.
fn slider(
    ui: &mut Ui,
    about: &About,
    mut number: f64,
    default: Option<&Value>,
    (least, most): (f64, f64),
    is_whole: bool,
) -> Option<f64> {
    let default = default.and_then(|value| value.as_float().or(value.as_integer().map(|i| i as f64))).unwrap_or(number);
    let usual = if most <= 20.0 { most } else { most.min((4.0 * default).max(10.0)) };
    let from = if least < -1e6 { -usual } else { least };
    let is_wide = usual / from.max(1e-3) > 500.0 && from > 0.0;
    let width = (ui.available_width() - 78.0).max(40.0);
    ui.spacing_mut().slider_width = width;
    let mut slider = egui::Slider::new(&mut number, from..=usual)
        .clamping(SliderClamping::Never)
        .logarithmic(is_wide)
        .suffix(unit(&about.help))
        .max_decimals(if is_whole { 0 } else { 4 });
    if is_whole {
        slider = slider.integer();
    }
    ui.add(slider).on_hover_text(&about.help).changed().then(|| number.clamp(least, most))
}

/// Three numbers; a colour has a swatch before them.
fn triple(ui: &mut Ui, values: &[Value], (least, most): (f64, f64)) -> Option<Value> {
    let number = |value: &Value| value.as_float().or(value.as_integer().map(|i| i as f64)).unwrap_or(0.0);
    let mut numbers: Vec<f64> = values.iter().map(number).collect();
    let largest = numbers.iter().fold(0.0f64, |largest, value| largest.max(value.abs()));
    let mut is_changed = false;
    for number in &mut numbers {
        let drag = egui::DragValue::new(number).speed((0.01 * largest).max(0.001)).range(least..=most).max_decimals(4);
        is_changed |= ui.add(drag).changed();
    }
    is_changed.then(|| Value::Array(numbers.into_iter().map(Value::Float).collect()))
}

/// A text that counts when it is finished.
fn text_field(ui: &mut Ui, name: &str, text: &str) -> Option<String> {
    let id = ui.scope_id().with(name);
    let mut edited = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| text.to_owned());
    let response = ui.add(egui::TextEdit::singleline(&mut edited).desired_width(f32::INFINITY));
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        return (edited != text).then_some(edited);
    }
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, edited));
    }
    None
}

/// The unit of a number, by its explanation.
fn unit(help: &str) -> &'static str {
    let units = [
        ("this many particle radii", " r"),
        ("in particle radii", " r"),
        ("degrees", "°"),
        ("in pixels", " px"),
        ("Seconds", " s"),
        ("Frames per second", " /s"),
    ];
    units.iter().find(|(words, _)| help.contains(words)).map_or("", |(_, unit)| unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_setting_is_in_a_group_and_explained() {
        let controls = Controls::new();
        for about in &controls.about {
            assert!(controls.groups.contains(&about.group), "{} has no group", about.name);
            assert!(about.help.len() > 10, "{}", about.name);
        }
        let unit_of = |name: &str| unit(&controls.about.iter().find(|a| a.name == name).unwrap().help);
        assert_eq!(["strength", "fov", "filter-max-px", "kappa"].map(unit_of), [" r", "°", " px", ""]);
    }
}
