//! Tests of what the window knows of the loaded points.

use super::*;
use glam::Vec3;
use surfel::geometry::ColourMap;
use surfel::settings::methods::Method;

/// Three points in a row with a property of the file.
fn source(read: [Vec<f32>; 2]) -> Source {
    source_of("heat", read)
}

fn source_of(name: &str, read: [Vec<f32>; 2]) -> Source {
    let surfels = Surfels {
        positions: [0.0, 1.0, 2.0].map(|x| Vec3::new(x, 0.0, 0.0)).to_vec(),
        normals: vec![Vec3::Z; 3],
        radii: vec![0.5; 3],
        ..Default::default()
    };
    let model = Model { surfels, ..Default::default() };
    let read = Arc::new(move |_: &str, _: &dyn Progress| Ok(read.clone()));
    let properties = Some(PointProperties { names: vec![name.into()], read });
    Source::new(Loaded {
        surface: Ok(ExactSurface::new(Arc::new(|_| Err(Error::Cancelled)))),
        properties,
        ..Loaded::new(model, Method::ALL[0])
    })
}

fn wait(source: &mut Source) -> Result<()> {
    while source.reading.is_some() {
        source.take_property()?;
    }
    Ok(())
}

#[test]
fn points_are_coloured_by_coordinates_and_by_properties_of_the_file() {
    let mut source = source([vec![5.0, f32::NAN, 7.0], vec![]]);
    source.colour_by(ColourAttribute::X);
    source.applied = source.wanted;
    assert_eq!(source.wanted.range, ValueRange { min: 0.0, max: 2.0 });
    let map = ColourMap::default();
    let codes = |parts: [Option<f64>; 3]| {
        let code = |part: Option<f64>| part.map_or([128; 3], |part| map.at(part));
        Some(Colours::Srgb8(parts.map(code).map(|[r, g, b]| [r, g, b, 0]).to_vec()))
    };
    assert_eq!(source.visible_model().surfels.colours, codes([Some(0.0), Some(0.5), Some(1.0)]));
    assert!(
        source.surface().err().unwrap().contains("under these colours"),
        "its colours are not the surface's"
    );
    source.colour_by(ColourAttribute::Property(0));
    wait(&mut source).unwrap();
    source.applied = source.wanted;
    assert_eq!(source.name(source.wanted.attribute), "heat");
    assert_eq!(source.visible_model().surfels.colours, codes([Some(0.0), None, Some(1.0)]));
    source.colour_by(ColourAttribute::Own);
    source.applied = source.wanted;
    assert_eq!(source.visible_model().surfels.colours, None);
    assert!(source.surface().is_ok());
}

#[test]
fn a_property_of_a_changed_file_is_refused() {
    let mut source = source([vec![1.0; 4], vec![]]);
    source.colour_by(ColourAttribute::Property(0));
    assert!(wait(&mut source).unwrap_err().to_string().contains("changed"));
    assert_eq!(source.wanted.attribute, ColourAttribute::Own);
}

#[test]
fn a_range_that_the_user_chose_applies_to_the_next_state() {
    let range = |min, max| ValueRange { min, max };
    let next = |saved: &SavedAppearance| {
        let mut next = source([vec![1.0, 2.0, 9.0], vec![]]);
        next.restore(saved);
        wait(&mut next).unwrap();
        next.wanted
    };
    for by in [ColourAttribute::Property(0), ColourAttribute::X] {
        let mut old = source([vec![5.0, 6.0, 7.0], vec![]]);
        old.colour_by(by);
        let reading = old.saved_appearance();
        wait(&mut old).unwrap();
        old.wanted.map = ColourMap::Turbo;
        let default = next(&old.saved_appearance());
        assert_eq!((default.attribute, default.map), (by, ColourMap::Turbo));
        let expected = if by == ColourAttribute::X { range(0.0, 2.0) } else { range(1.0, 9.0) };
        assert_eq!(default.range, expected, "the default range of the new values");
        assert_eq!(next(&reading).attribute, by, "the property that was being read is read again");
        old.wanted.range = range(-3.0, 4.0);
        assert_eq!(next(&old.saved_appearance()).range, range(-3.0, 4.0));
        // Reloaded twice before the property could be read, or with a state between that lacks it.
        for name in ["heat", "cold"] {
            let mut between = source_of(name, [vec![1.0, 2.0, 9.0], vec![]]);
            between.restore(&old.saved_appearance());
            assert!(
                name == "heat"
                    || by == ColourAttribute::X
                    || between.wanted.attribute == ColourAttribute::Own
            );
            assert_eq!(next(&between.saved_appearance()), Appearance { attribute: by, ..old.wanted });
        }
    }
}

#[test]
fn the_last_choice_of_colours_counts() {
    let mut source = source([vec![5.0, 6.0, 7.0], vec![]]);
    source.colour_by(ColourAttribute::Property(0));
    source.colour_by(ColourAttribute::Y);
    wait(&mut source).unwrap();
    assert_eq!(source.wanted.attribute, ColourAttribute::Y);
}

#[test]
fn scaling_radii_leaves_the_loaded_model() {
    let mut source = source([vec![], vec![]]);
    source.wanted.radius_scale = 3.0;
    source.applied = source.wanted;
    assert_eq!(source.visible_model().surfels.radii, [1.5; 3]);
    assert_eq!(source.model.surfels.radii, [0.5; 3]);
}

#[test]
fn a_scene_is_shaded_by_its_first_shading_unless_another_was_chosen() {
    let with = |shading| Settings { shading, ..Settings::default() };
    let source = |shading, ao| {
        let model = Model::default();
        Source::new(Loaded { shading, ao, ..Loaded::new(model, Method::ALL[0]) })
    };
    let (dark, plain) = (source(Some(Shading::Edl), Some(0.0)), source(None, None));
    assert_eq!(dark.shaded(with(Shading::Lit)).shading, Shading::Edl);
    assert_eq!(dark.shaded(with(Shading::Normal)).shading, Shading::Normal);
    assert_eq!(plain.shaded(with(Shading::Lit)).shading, Shading::Lit);
    // So with ambient occlusion.
    let (foliage, occluded) =
        (source(Some(Shading::Lit), Some(1.0)), |ao| Settings { ao, ..with(Shading::Lit) });
    assert_eq!(foliage.shaded(occluded(0.0)), occluded(1.0));
    assert_eq!(foliage.shaded(occluded(0.5)), occluded(0.5));
}
