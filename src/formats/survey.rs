//! What a file tells of its points as a whole, so that a file of points that is written from it keeps it.

/// Scale, coordinate system and scans of a file; nothing for formats that have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Survey {
    /// Coordinate system as well-known text.
    pub(super) coordinate_system: Option<String>,
    /// Header and records of a LAS file.
    #[cfg(feature = "las")]
    pub(super) las: Option<super::las::Survey>,
    /// Scans of an E57 file.
    #[cfg(feature = "e57")]
    pub(super) scans: Vec<super::e57::ScanSurvey>,
}

impl Survey {
    /// The header and records of a LAS file, with its coordinate system as well-known text.
    #[cfg(feature = "las")]
    pub(super) fn of_las(coordinate_system: Option<String>, las: super::las::Survey) -> Self {
        let las = Some(las);
        Self {
            coordinate_system,
            las,
            #[cfg(feature = "e57")]
            scans: Vec::new(),
        }
    }

    /// The scans of an E57 file, with its coordinate system.
    #[cfg(feature = "e57")]
    pub(super) fn of_scans(coordinate_system: Option<String>, scans: Vec<super::e57::ScanSurvey>) -> Self {
        Self {
            coordinate_system,
            #[cfg(feature = "las")]
            las: None,
            scans,
        }
    }

    /// Whether the points are those of scans of an E57 file.
    pub(super) fn has_scans(&self) -> bool {
        #[cfg(feature = "e57")]
        let is_empty = self.scans.is_empty();
        #[cfg(not(feature = "e57"))]
        let is_empty = true;
        !is_empty
    }

    /// Coordinate system as well-known text, if the file has it.
    pub fn coordinate_system(&self) -> Option<&str> {
        self.coordinate_system.as_deref()
    }
}
