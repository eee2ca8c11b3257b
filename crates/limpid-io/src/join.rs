//! Particles of several files as those of one.

use crate::{Attribute, ParticleSet, Values};

/// What tells the files apart afterwards.
pub const PHASE: &str = "phase";

/// Joins particles of a file and of others, each with the number that its particles have for an attribute [`PHASE`].
///
/// Attributes that a file lacks are NaN for its particles. Ids stay distinct, but change; they go where a file has none.
/// Where files have radii, each particle has its own: a file without has the first one's.
pub fn join(first: (i32, ParticleSet), others: Vec<(i32, ParticleSet)>) -> ParticleSet {
    let (path, format) = (first.1.path.clone(), first.1.format);
    let files: Vec<(i32, ParticleSet)> = std::iter::once(first).chain(others).collect();
    let phase = |(phase, set): &(i32, ParticleSet)| vec![*phase; set.len()];
    let phases = files.iter().flat_map(phase).collect();
    let mut sets: Vec<ParticleSet> = files.into_iter().map(|(_, set)| set).collect();
    spread_radii(&mut sets);
    let mut names: Vec<(String, usize)> = Vec::new();
    for attribute in sets.iter().flat_map(|set| &set.attributes).filter(|attribute| attribute.name != PHASE) {
        if !names.iter().any(|(name, _)| *name == attribute.name) {
            names.push((attribute.name.clone(), attribute.components));
        }
    }
    let joined = names.into_iter().filter_map(|(name, components)| {
        let values = match name.as_str() {
            "id" => distinct_ids(&sets)?,
            _ => joined(&sets, &name, components),
        };
        Some(Attribute { name, components, values })
    });
    let mut attributes: Vec<Attribute> = joined.collect();
    attributes.push(Attribute { name: PHASE.into(), components: 1, values: Values::I32(phases) });
    let origin = sets[0].origin;
    let positions = sets.iter().flat_map(|set| {
        let shift = [0, 1, 2].map(|axis| set.origin[axis] - origin[axis]);
        set.positions.iter().map(move |at| [0, 1, 2].map(|axis| (f64::from(at[axis]) + shift[axis]) as f32))
    });
    let positions = positions.collect();
    let warnings = sets.iter().flat_map(|set| set.warnings.clone()).collect();
    ParticleSet { path, format, origin, positions, attributes, file_radius: None, warnings }
}

/// Gives each particle a radius where any file has one.
fn spread_radii(sets: &mut [ParticleSet]) {
    let own = |set: &ParticleSet| set.radii().and_then(|radii| radii.first().copied()).map(f64::from);
    let Some(other) = sets.iter().find_map(|set| own(set).or(set.file_radius)) else { return };
    for set in sets.iter_mut().filter(|set| set.radii().is_none()) {
        let radius = set.file_radius.unwrap_or(other) as f32;
        set.attributes.retain(|attribute| attribute.name != "radius");
        let values = Values::F32(vec![radius; set.len()]);
        set.attributes.push(Attribute { name: "radius".into(), components: 1, values });
    }
}

/// An attribute of all sets, in the type that they share.
fn joined(sets: &[ParticleSet], name: &str, components: usize) -> Values {
    let of = |set: &ParticleSet| set.attribute(name).filter(|a| a.components == components).map(|a| a.values.clone());
    let parts: Vec<Option<Values>> = sets.iter().map(of).collect();
    let is_single = parts.iter().flatten().all(|values| matches!(values, Values::F32(_)));
    if is_single {
        let floats = parts.iter().zip(sets).flat_map(|(values, set)| match values {
            Some(values) => values.floats().into_owned(),
            None => vec![f32::NAN; components * set.len()],
        });
        return Values::F32(floats.collect());
    }
    let numbers = parts.iter().zip(sets).flat_map(|(values, set)| match values {
        Some(values) => (0..values.len()).map(|index| values.get(index)).collect(),
        None => vec![f64::NAN; components * set.len()],
    });
    Values::F64(numbers.collect())
}

/// Ids that no two particles share where none did before; None: some have no ids.
fn distinct_ids(sets: &[ParticleSet]) -> Option<Values> {
    let count = sets.len() as i64;
    let mut ids = Vec::new();
    for (place, set) in sets.iter().enumerate().filter(|(_, set)| !set.is_empty()) {
        let Values::I64(own) = &set.attribute("id")?.values else { return None };
        ids.extend(own.iter().map(|id| id.wrapping_mul(count).wrapping_add(place as i64)));
    }
    Some(Values::I64(ids))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Format;

    fn set(count: usize, origin: f64, attributes: Vec<(&str, usize, Values)>) -> ParticleSet {
        let attribute =
            |(name, components, values): (&str, usize, Values)| Attribute { name: name.into(), components, values };
        ParticleSet {
            path: "a.vtk".into(),
            format: Format::Vtk,
            origin: [origin, 0.0, 0.0],
            positions: (0..count).map(|i| [i as f32, 0.0, 0.0]).collect(),
            attributes: attributes.into_iter().map(attribute).collect(),
            file_radius: None,
            warnings: vec!["odd".into()],
        }
    }

    #[test]
    fn particles_of_files_stay_who_they_are() {
        let water = set(
            2,
            100.0,
            vec![("id", 1, Values::I64(vec![0, 1])), ("velocity", 3, Values::F32((0..6).map(|x| x as f32).collect()))],
        );
        let oil = set(1, 90.0, vec![("id", 1, Values::I64(vec![0])), ("Type", 1, Values::I32(vec![7]))]);
        let both = join((0, water), vec![(2, oil)]);
        assert_eq!(both.positions, [[0.0; 3], [1.0, 0.0, 0.0], [-10.0, 0.0, 0.0]]);
        assert_eq!(both.attribute(PHASE).unwrap().values, Values::I32(vec![0, 0, 2]));
        assert_eq!(both.attribute("id").unwrap().values, Values::I64(vec![0, 2, 1]));
        let Values::F32(velocity) = &both.attribute("velocity").unwrap().values else { panic!() };
        assert!(velocity[..6] == [0.0, 1.0, 2.0, 3.0, 4.0, 5.0] && velocity[6..].iter().all(|v| v.is_nan()));
        let kinds = both.scalars("Type").unwrap();
        assert!(kinds[0].is_nan() && kinds[1].is_nan() && kinds[2] == 7.0);
        assert_eq!(both.warnings.len(), 2);
        assert!(both.attributes.iter().all(|a| a.values.len() == a.components * both.len()));
    }

    #[test]
    fn each_file_keeps_its_radius() {
        let water = ParticleSet { file_radius: Some(0.5), ..set(2, 0.0, vec![]) };
        let oil = set(1, 0.0, vec![("radius", 1, Values::F32(vec![0.25]))]);
        let other = set(1, 0.0, vec![("id", 1, Values::I64(vec![5]))]);
        let all = join((0, water), vec![(1, oil), (2, other)]);
        assert_eq!(all.radii(), Some(&[0.5, 0.5, 0.25, 0.5][..]));
        assert!(all.file_radius.is_none() && all.attribute("id").is_none());
    }
}
