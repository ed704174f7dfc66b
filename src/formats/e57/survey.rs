//! What an E57 file tells of its scans.

use e57::{DateTime, PointCloud, Quaternion, Transform, Translation};

/// A scan of a file that is read, for a file that is written from it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ScanSurvey {
    pub name: Option<String>,
    pub description: Option<String>,
    /// Vendor, model and serial number of the scanner.
    pub sensor: [Option<String>; 3],
    /// Rotation as x y z w, and translation.
    pub pose: Option<([f64; 4], [f64; 3])>,
    /// Seconds since the epoch of GPS, and whether an atomic clock was referenced.
    pub start: Option<(f64, bool)>,
}

impl ScanSurvey {
    pub fn of(cloud: &PointCloud) -> Self {
        let pose =
            |Transform { rotation: r, translation: t }: &Transform| ([r.x, r.y, r.z, r.w], [t.x, t.y, t.z]);
        Self {
            name: cloud.name.clone(),
            description: cloud.description.clone(),
            sensor: [&cloud.sensor_vendor, &cloud.sensor_model, &cloud.sensor_serial].map(Clone::clone),
            pose: cloud.transform.as_ref().map(pose),
            start: cloud.acquisition_start.as_ref().map(|start| (start.gps_time, start.atomic_reference)),
        }
    }

    /// The pose in the library's terms.
    pub fn transform(&self) -> Option<Transform> {
        let ([x, y, z, w], [a, b, c]) = self.pose?;
        let translation = Translation { x: a, y: b, z: c };
        Some(Transform { rotation: Quaternion { w, x, y, z }, translation })
    }

    /// The beginning of the acquisition in the library's terms.
    pub fn start(&self) -> Option<DateTime> {
        let (gps_time, atomic_reference) = self.start?;
        Some(DateTime { gps_time, atomic_reference })
    }
}
