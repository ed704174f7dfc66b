//! Materials: specular reflection of points.

use super::Surfels;
use crate::error::{Error, Result};
use std::cmp::Reverse;
use std::collections::HashMap;
use std::sync::Arc;

/// Specular reflection of a surface (Blinn–Phong, linear light).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Material {
    /// Specular factor, linear RGB; 0 or more.
    pub specular: [f32; 3],
    /// Exponent, above 0.
    pub shininess: f32,
}

/// A table of materials and one index per point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Materials {
    /// At most [`Materials::MOST`] materials.
    pub table: Arc<[Material]>,
    /// Index of the point's material, or [`Materials::NONE`] for the frame's lighting.
    pub of: Vec<u16>,
}

impl Materials {
    /// Index of points without a material.
    pub const NONE: u16 = u16::MAX;
    /// Maximum number of materials in a table.
    pub const MOST: usize = Self::NONE as usize;

    /// The material of a point, if any; `None` also beyond the end.
    pub fn material(&self, point: usize) -> Option<Material> {
        self.table.get(usize::from(*self.of.get(point)?)).copied()
    }

    /// Validates the indices, the number of materials, and their values.
    pub(super) fn check(&self) -> Result<()> {
        let count = self.table.len();
        if count > Self::MOST {
            let text = format!("{count} materials: give at most {}", Self::MOST);
            return Err(Error::Usage(text));
        }
        let within = |value: f32| (0.0..=Surfels::LARGEST).contains(&value);
        let usable =
            |m: &Material| m.specular.into_iter().all(within) && within(m.shininess) && m.shininess > 0.0;
        if let Some(number) = self.table.iter().position(|material| !usable(material)) {
            let Material { specular, shininess } = self.table[number];
            return Err(Error::Usage(format!(
                "material {number} has a specular factor of {specular:?} and an exponent of {shininess}: give finite ones, 0 or more and above 0"
            )));
        }
        match self.of.iter().find(|&&number| number != Self::NONE && usize::from(number) >= count) {
            None => Ok(()),
            Some(number) => {
                Err(Error::Usage(format!("a point has material {number} of {count}: count from 0")))
            }
        }
    }

    /// Indices of the points at `indices`, in that order.
    pub(crate) fn gather(&self, indices: &[u32]) -> Self {
        Self { table: self.table.clone(), of: indices.iter().map(|&i| self.of[i as usize]).collect() }
    }

    /// The most frequent material of each group of points, the first one among equals; none for an empty group.
    pub(super) fn of_groups<G: Iterator<Item = u32>>(&self, groups: impl Iterator<Item = G>) -> Self {
        let most = |group: G| {
            // Number of occurrences, and first position, reversed.
            let mut found = HashMap::<u16, (usize, Reverse<usize>)>::new();
            for (i, point) in group.enumerate() {
                found.entry(self.of[point as usize]).or_insert((0, Reverse(i))).0 += 1;
            }
            found.into_iter().max_by_key(|(_, often)| *often).map_or(Self::NONE, |(number, _)| number)
        };
        Self { table: self.table.clone(), of: groups.map(most).collect() }
    }

    /// Joins the materials of consecutive sets of points, each with its number of points; `None` if no set has any. Equal tables are
    /// shared.
    ///
    /// # Errors
    /// [`Error::Usage`] for more than [`Materials::MOST`] materials.
    pub(crate) fn join(parts: &[(Option<&Self>, usize)]) -> Result<Option<Self>> {
        if parts.iter().all(|(part, _)| part.is_none()) {
            return Ok(None);
        }
        let (mut tables, mut table, mut of) =
            (Vec::<(&Arc<[Material]>, usize)>::new(), Vec::new(), Vec::new());
        for (part, count) in parts {
            let Some(part) = part else {
                of.resize(of.len() + count, Self::NONE);
                continue;
            };
            let first = match tables.iter().find(|(known, _)| **known == part.table) {
                Some((_, first)) => *first,
                None => {
                    tables.push((&part.table, table.len()));
                    table.extend_from_slice(&part.table);
                    table.len() - part.table.len()
                }
            };
            if table.len() > Self::MOST {
                let text = format!("{} materials in one scene: give at most {}", table.len(), Self::MOST);
                return Err(Error::Usage(text));
            }
            // Fits: there are at most `MOST` materials.
            let moved = |&number: &u16| if number == Self::NONE { number } else { number + first as u16 };
            of.extend(part.of.iter().map(moved));
        }
        Ok(Some(Self { table: table.into(), of }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn material(red: f32) -> Material {
        Material { specular: [red, 0.0, 0.0], shininess: 8.0 }
    }

    fn materials(reds: &[f32], of: &[u16]) -> Materials {
        Materials { table: reds.iter().copied().map(material).collect(), of: of.to_vec() }
    }

    #[test]
    fn tables_follow_one_another_and_equal_ones_are_one() {
        let [a, b] = [materials(&[0.1, 0.2], &[1, 0, Materials::NONE]), materials(&[0.3], &[0])];
        let joined =
            Materials::join(&[(Some(&b), 1), (None, 2), (Some(&a), 3), (Some(&b), 1)]).unwrap().unwrap();
        let none = Materials::NONE;
        assert_eq!(joined, materials(&[0.3, 0.1, 0.2], &[0, none, none, 2, 1, none, 0]));
        assert_eq!(Materials::join(&[(None, 5)]).unwrap(), None);
        let full = materials(&vec![0.5; Materials::MOST], &[0]);
        let refused = Materials::join(&[(Some(&full), 1), (Some(&b), 1)]).unwrap_err().to_string();
        assert!(refused.contains("65536 materials in one scene"), "{refused}");
    }

    #[test]
    fn a_group_has_the_material_of_most() {
        let all = materials(&[0.1, 0.2, 0.3], &[0, 1, 2, 1, Materials::NONE, 2]);
        let groups: [&[u32]; 5] = [&[0, 1, 3], &[2, 1], &[4], &[], &[0, 1, 2, 3, 5]];
        let of = all.of_groups(groups.iter().map(|group| group.iter().copied())).of;
        assert_eq!(of, [1, 2, Materials::NONE, Materials::NONE, 1]);
    }

    #[test]
    fn what_cannot_be_is_refused() {
        assert!(materials(&[0.1], &[0, Materials::NONE]).check().is_ok());
        let dull = Materials { table: [Material { specular: [0.0; 3], shininess: 0.0 }].into(), of: vec![] };
        for (wrong, expected) in [
            (materials(&[0.1], &[1]), "material 1 of 1"),
            (materials(&[0.1, f32::NAN], &[]), "material 1 has a specular"),
            (materials(&[-0.1], &[]), "material 0 has a specular"),
            (dull, "exponent of 0"),
        ] {
            let text = wrong.check().unwrap_err().to_string();
            assert!(text.contains(expected), "{text}");
        }
    }
}
