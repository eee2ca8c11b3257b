//! A survey of one frame on its way to where the frame is drawn.

use super::Survey;
use glam::DVec3;
use limpid::Bounds;
use limpid_io::{ParticleSet, Radius, RadiusSource};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What a survey of one frame, [`Survey::settle`]d without options, knows beside the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    bounds: Option<[[f64; 3]; 2]>,
    extent: Option<[[f64; 3]; 2]>,
    warnings: Vec<String>,
    own_radius: Option<FoundRadius>,
    ranges: Vec<FoundRange>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct FoundRadius {
    value: f64,
    per_particle: bool,
    is_in_file: bool,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct FoundRange {
    name: String,
    range: Option<[f64; 2]>,
}

impl Survey {
    /// What is known beside the frame.
    pub fn findings(&self) -> Findings {
        let corners = |bounds: Bounds| [bounds.min.to_array(), bounds.max.to_array()];
        let found = |radius: Radius| FoundRadius {
            value: radius.value,
            per_particle: radius.per_particle,
            is_in_file: radius.source == RadiusSource::File,
        };
        let range = |(name, range): (&String, &Option<[f64; 2]>)| FoundRange { name: name.clone(), range: *range };
        Findings {
            bounds: self.bounds.map(corners),
            extent: self.extent.map(corners),
            warnings: self.warnings.clone(),
            own_radius: self.own_radius.map(found),
            ranges: self.ranges.iter().map(range).collect(),
        }
    }

    /// The survey again, of the frame that it was of.
    pub fn of_findings(findings: Findings, set: &Arc<ParticleSet>) -> Self {
        let bounds = |[min, max]: [[f64; 3]; 2]| Bounds { min: DVec3::from_array(min), max: DVec3::from_array(max) };
        let radius = |found: FoundRadius| Radius {
            value: found.value,
            per_particle: found.per_particle,
            source: if found.is_in_file { RadiusSource::File } else { RadiusSource::Estimated },
        };
        let own_radius = findings.own_radius.map(radius);
        Self {
            bounds: findings.bounds.map(bounds),
            extent: findings.extent.map(bounds),
            warnings: findings.warnings,
            ranges: findings.ranges.into_iter().map(|found| (found.name, found.range)).collect(),
            radius: own_radius,
            own_radius,
            largest: Some(Arc::clone(set)),
        }
    }
}
