//! Named choices: in options, reports, results and the window.

use std::str::FromStr;
use strum::{EnumMessage, VariantArray};

/// A small set of named choices with one line of help each.
pub trait Choice: Copy + Send + Sync + 'static {
    /// All choices, in the order of options.
    const ALL: &'static [Self];

    /// The name: the variant's in kebab case.
    fn name(self) -> &'static str;

    /// All names, including [`name`](Self::name).
    fn names(self) -> &'static [&'static str];

    /// The help: the first line of its documentation, which is a whole sentence, without the full stop.
    fn about(self) -> &'static str;

    /// The choice with a name.
    fn named(name: &str) -> Option<Self>;
}

impl<T> Choice for T
where
    T: Copy + Send + Sync + 'static + VariantArray + EnumMessage + FromStr + Into<&'static str>,
{
    const ALL: &'static [Self] = T::VARIANTS;

    fn name(self) -> &'static str {
        self.into()
    }

    fn names(self) -> &'static [&'static str] {
        self.get_serializations()
    }

    fn about(self) -> &'static str {
        let line = self.get_documentation().and_then(|text| text.lines().next());
        line.map_or("", |text| text.trim_end_matches('.'))
    }

    fn named(name: &str) -> Option<Self> {
        name.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ColourMap;
    use crate::settings::splatting::{Filter, Footprint, Normalization, Shade, Visibility};
    use crate::settings::{Alpha, Cull, Hierarchy, Precision, Rasterizer, Shading, Widen};

    fn check<T: Choice + PartialEq + std::fmt::Debug>() {
        for one in T::ALL {
            assert_eq!(T::named(one.name()), Some(*one));
            assert!(
                one.names().iter().all(|name| T::named(name) == Some(*one)),
                "{one:?}: {:?}",
                one.names()
            );
            let kebab = |name: &str| name.chars().all(|c| c.is_ascii_lowercase() || c == '-');
            assert!(kebab(one.name()), "{one:?}");
            // One line of help.
            let about = one.about();
            assert!((3..=120).contains(&about.chars().count()), "{one:?}: {about}");
            assert!(!about.contains(['`', '[', '\n']), "{one:?}: {about}");
        }
        assert_eq!(T::named("none such"), None);
    }

    #[test]
    fn every_choice_has_a_name_and_a_line_of_help() {
        check::<Footprint>();
        check::<Filter>();
        check::<Visibility>();
        check::<Normalization>();
        check::<Shade>();
        check::<Rasterizer>();
        check::<Hierarchy>();
        check::<Precision>();
        check::<Widen>();
        check::<Cull>();
        check::<Alpha>();
        check::<Shading>();
        check::<ColourMap>();
        assert_eq!(Shading::named("colour"), Some(Shading::Colour));
        assert_eq!(Cull::None.about(), "Both sides are drawn");
    }
}
