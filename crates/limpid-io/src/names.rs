//! One name for each attribute that solvers call by several, and vectors from columns of components.

use crate::raw::{Positions, zip};
use crate::{Attribute, Values};

/// Canonical names with their aliases, best first, and the component counts that make sense.
const ALIASES: [(&str, &[&str], &[usize]); 6] = [
    ("velocity", &["velocity", "vel", "v", "velocities", "velo"], &[3]),
    ("density", &["density", "rho", "Rhop", "densities"], &[1]),
    ("radius", &["radius", "pscale", "width", "widths", "h", "radii"], &[1]),
    ("id", &["id", "Idp", "ids"], &[1]),
    ("color", &["color", "Cd", "colors"], &[3, 4]),
    ("life", &["life", "lifetime"], &[1]),
];

/// Columns whose names do not say that they belong together.
const GROUPS: [(&str, &[&str]); 5] = [
    ("velocity", &["u", "v", "w"]),
    ("color", &["red", "green", "blue", "alpha"]),
    ("color", &["red", "green", "blue"]),
    ("color", &["r", "g", "b", "a"]),
    ("color", &["r", "g", "b"]),
];

/// What may follow a vector's name in the names of its columns: `vx`, `velocity:0` (ParaView), `velocity_0`, `Velocity[i]` (Star-CCM+),
/// and for positions `x-coordinate` (Fluent).
const SUFFIXES: [[&str; 3]; 6] = [
    ["x", "y", "z"],
    [":0", ":1", ":2"],
    ["_0", "_1", "_2"],
    ["[0]", "[1]", "[2]"],
    ["[i]", "[j]", "[k]"],
    ["x-coordinate", "y-coordinate", "z-coordinate"],
];

/// Names of positions as a whole; without a name they are bare x, y, z.
const POSITIONS: [&str; 9] = ["", "P", "pos", "position", "positions", "points", "coordinates", "particles", "arr_0"];

/// What else they are called as a whole, in Taichi's programs, which say v of velocities.
const WHOLE: &str = "x";

/// Names that an array without rows has for positions alone.
const FLAT: [&str; 4] = ["pos", "positions", "points", "coordinates"];

/// Renames what has a canonical name, and brings it into its canonical form.
pub(crate) fn make_canonical(attributes: &mut [Attribute]) {
    for (name, aliases, components) in ALIASES {
        let found = aliases.iter().find_map(|alias| {
            let fits = |a: &Attribute| a.name.eq_ignore_ascii_case(alias) && components.contains(&a.components);
            attributes.iter().position(fits)
        });
        let Some(attribute) = found.map(|index| &mut attributes[index]) else { continue };
        let scale = match (name, &attribute.values) {
            // A width is a diameter.
            ("radius", _) if attribute.name.to_ascii_lowercase().starts_with("width") => 0.5,
            ("color", Values::U8(_)) => 1.0 / 255.0,
            _ => 1.0,
        };
        attribute.name = name.into();
        match (name, &attribute.values) {
            ("id", Values::U8(ids)) => attribute.values = Values::I64(ids.iter().map(|&id| id.into()).collect()),
            ("id", Values::I32(ids)) => attribute.values = Values::I64(ids.iter().map(|&id| id.into()).collect()),
            ("id", Values::F64(ids)) if ids.iter().all(|id| id.fract() == 0.0) => {
                attribute.values = Values::I64(ids.iter().map(|&id| id as i64).collect());
            }
            ("id", _) => {}
            (_, Values::F32(_)) if scale == 1.0 => {}
            (_, values) => attribute.values = Values::F32(values.floats().iter().map(|x| x * scale).collect()),
        }
    }
}

/// An array whose numbers may not have been read.
pub(crate) struct Named<'a> {
    pub name: &'a str,
    pub components: usize,
    pub rows: u64,
}

/// Which arrays are the positions: one of x, y and z, or three of one length.
pub(crate) fn positions_among(arrays: &[Named]) -> Option<Vec<usize>> {
    let names_positions =
        |a: &Named| a.components == 3 && POSITIONS.iter().chain([&WHOLE]).any(|name| a.name.eq_ignore_ascii_case(name));
    if let Some(index) = arrays.iter().position(names_positions) {
        return Some(vec![index]);
    }
    let columns = SUFFIXES.iter().find_map(|suffixes| {
        POSITIONS.iter().find_map(|base| {
            ["", "_", "."].iter().find_map(|joint| {
                let index_of =
                    |name: String| arrays.iter().position(|a| a.components == 1 && a.name.eq_ignore_ascii_case(&name));
                suffixes.iter().map(|suffix| index_of(format!("{base}{joint}{suffix}"))).collect::<Option<Vec<_>>>()
            })
        })
    })?;
    columns.iter().all(|&column| arrays[column].rows == arrays[columns[0]].rows).then_some(columns)
}

/// Takes the positions out of an attribute list, as three columns or as one array.
pub(crate) fn take_positions(attributes: &mut Vec<Attribute>) -> Option<Positions> {
    let named = |a| {
        let Attribute { name, components, values }: &Attribute = a;
        Named { name, components: *components, rows: (values.len() / components.max(&1)) as u64 }
    };
    match positions_among(&attributes.iter().map(named).collect::<Vec<_>>())?[..] {
        [whole] => Some(Positions::from_triples(attributes.remove(whole).values)),
        ref columns => {
            let columns = take(attributes, columns);
            Some(Positions::from_columns(<[Values; 3]>::try_from(columns).ok()?))
        }
    }
}

/// Whether an array of this name holds positions, even where they are written as one list of numbers.
pub(crate) fn is_flat_positions(name: &str) -> bool {
    FLAT.iter().any(|other| name.eq_ignore_ascii_case(other))
}

/// Joins the columns of components into vectors.
pub(crate) fn join_components(attributes: &mut Vec<Attribute>) {
    for (name, columns) in GROUPS {
        if let Some(columns) = find(attributes, columns) {
            join(attributes, name.into(), &columns);
        }
    }
    for suffixes in SUFFIXES {
        let mut index = 0;
        while index < attributes.len() {
            let base = strip_suffix(&attributes[index].name, suffixes[0]).filter(|base| !base.is_empty());
            let columns = base.and_then(|base| find(attributes, &suffixes.map(|suffix| format!("{base}{suffix}"))));
            match (base.map(vector_of_base), columns) {
                (Some(name), Some(columns)) => join(attributes, name, &columns),
                _ => index += 1,
            }
        }
    }
}

/// The vector whose components have these names, as [`join_components`] would join them.
pub(crate) fn vector_of(names: [&str; 3]) -> Option<String> {
    let suffixes = SUFFIXES.iter().find(|suffixes| {
        let bases = [0, 1, 2].map(|k| strip_suffix(names[k], suffixes[k]));
        let is_first = |base: &Option<&str>| base.zip(bases[0]).is_some_and(|(a, b)| a.eq_ignore_ascii_case(b));
        bases[0].is_some_and(|base| !base.is_empty()) && bases.iter().all(is_first)
    })?;
    strip_suffix(names[0], suffixes[0]).map(vector_of_base)
}

/// What a vector is called whose components begin like this.
fn vector_of_base(base: &str) -> String {
    let name = base.trim_end_matches(['_', '.', ':']);
    if name.eq_ignore_ascii_case("n") { "normal".into() } else { name.into() }
}

fn strip_suffix<'a>(name: &'a str, suffix: &str) -> Option<&'a str> {
    let (base, end) = name.split_at_checked(name.len().checked_sub(suffix.len())?)?;
    end.eq_ignore_ascii_case(suffix).then_some(base)
}

/// Indices of the single-component attributes of these names, if all are there.
fn find<S: AsRef<str>>(attributes: &[Attribute], names: &[S]) -> Option<Vec<usize>> {
    let index_of =
        |name: &S| attributes.iter().position(|a| a.components == 1 && a.name.eq_ignore_ascii_case(name.as_ref()));
    names.iter().map(index_of).collect()
}

fn take(attributes: &mut Vec<Attribute>, columns: &[usize]) -> Vec<Values> {
    let values = columns.iter().map(|&column| std::mem::replace(&mut attributes[column].values, Values::U8(vec![])));
    let values = values.collect();
    let mut index = 0;
    attributes.retain(|_| {
        index += 1;
        !columns.contains(&(index - 1))
    });
    values
}

fn join(attributes: &mut Vec<Attribute>, name: String, columns: &[usize]) {
    let at = *columns.iter().min().expect("a vector has components");
    let columns = take(attributes, columns);
    attributes.insert(at, Attribute { name, components: columns.len(), values: interleave(&columns) });
}

/// Columns as rows.
pub(crate) fn interleave(columns: &[Values]) -> Values {
    let len = columns[0].len();
    let same_type = columns.iter().all(|c| std::mem::discriminant(c) == std::mem::discriminant(&columns[0]));
    let order = || (0..len).flat_map(|row| columns.iter().map(move |column| (column, row)));
    macro_rules! typed {
        ($kind:path) => {{
            let arrays: Vec<_> = columns.iter().filter_map(|c| if let $kind(a) = c { Some(a) } else { None }).collect();
            $kind(match arrays[..] {
                // By far the most frequent: by itself four times as fast.
                [x, y, z] => zip(x, y, z).into_flattened(),
                _ => (0..len).flat_map(|row| arrays.iter().map(move |array| array[row])).collect(),
            })
        }};
    }
    match &columns[0] {
        _ if !same_type => Values::F64(order().map(|(column, row)| column.get(row)).collect()),
        Values::U8(_) => typed!(Values::U8),
        Values::I32(_) => typed!(Values::I32),
        Values::I64(_) => typed!(Values::I64),
        Values::F32(_) => typed!(Values::F32),
        Values::F64(_) => typed!(Values::F64),
    }
}
