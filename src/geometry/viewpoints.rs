//! Viewpoints of clouds that several scans make up.

use super::{Cloud, View};

/// Where each point of a cloud was seen from.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Viewpoints {
    /// The scans.
    pub views: Vec<View>,
    /// Scan of each point.
    pub scans: Vec<u16>,
}

impl Viewpoints {
    /// Where a point was seen from.
    pub fn view(&self, point: usize) -> View {
        self.scans.get(point).and_then(|scan| self.views.get(usize::from(*scan))).copied().unwrap_or_default()
    }

    /// Those of the points `kept`, in that order.
    pub(crate) fn gather(&self, kept: impl Iterator<Item = usize>) -> Self {
        Self { views: self.views.clone(), scans: kept.map(|point| self.scans[point]).collect() }
    }

    /// Those of the points of all parts; `None` if they share a view, or there are too many scans to be numbered.
    pub(super) fn join(parts: &[Cloud]) -> Option<Self> {
        let first = parts.first().map(|part| part.view)?;
        if parts.iter().all(|part| part.viewpoints.is_none() && part.view == first) {
            return None;
        }
        let mut all = Self::default();
        for part in parts {
            let before = u16::try_from(all.views.len()).ok()?;
            match &part.viewpoints {
                Some(own) => {
                    all.views.extend(&own.views);
                    u16::try_from(all.views.len()).ok()?;
                    all.scans.extend(own.scans.iter().map(|scan| before + scan));
                }
                None => {
                    all.views.push(part.view);
                    all.scans.extend(std::iter::repeat_n(before, part.len()));
                }
            }
        }
        Some(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn scans_of_parts_are_numbered_one_after_the_other() {
        let [up, from] = [View::Towards(Vec3::Z), View::From(Vec3::X)];
        let own = Viewpoints { views: vec![from, View::Unknown], scans: vec![1, 0, 0] };
        let part =
            |count: usize, view| Cloud { positions: vec![Vec3::ZERO; count], view, ..Default::default() };
        let several = Cloud { viewpoints: Some(own.clone()), ..part(3, View::Unknown) };
        let parts = [part(2, up), several, part(1, from)];
        let all = Viewpoints::join(&parts).unwrap();
        let views: Vec<View> = (0..6).map(|point| all.view(point)).collect();
        assert_eq!(views, [up, up, View::Unknown, from, from, from]);
        assert_eq!(all.view(6), View::Unknown);
        let some = all.gather([5, 2].into_iter());
        assert_eq!([some.view(0), some.view(1)], [from, View::Unknown]);
        assert_eq!(Viewpoints::join(&[part(1, up), part(2, up)]), None);
        let many = Viewpoints { views: vec![up; 65_535], scans: vec![0; 1] };
        let many = Cloud { viewpoints: Some(many), ..part(1, View::Unknown) };
        assert!(Viewpoints::join(&[many.clone(), part(1, up)]).is_some());
        assert_eq!(Viewpoints::join(&[many.clone(), many]), None);
    }
}
