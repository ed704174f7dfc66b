//! Layouts of declared properties.

use super::*;

fn vertex(names: &str, scalar: Scalar) -> Element {
    let property = |name: &str| Property { name: name.into(), kind: Kind::Scalar(scalar) };
    Element { name: "vertex".into(), count: 1, properties: names.split_whitespace().map(property).collect() }
}

fn chosen(name: &str) -> ReadOptions {
    ReadOptions { scalar: Some(name.into()), ..Default::default() }
}

fn layout(names: &str, scalar: Scalar) -> Layout {
    Layout::of(&vertex(names, scalar), &ReadOptions::default(), false).unwrap()
}

#[test]
fn diameters_and_tangents_are_those_of_lines() {
    let of =
        |names: &str, lines| Layout::of(&vertex(names, Scalar::F32), &ReadOptions::default(), lines).unwrap();
    let line = of("x y z diameter tx ty tz", true);
    assert_eq!((line.columns[RADIUS], line.diameters), (Some(3), true));
    assert_eq!(line.columns[TANGENT..TEXTURE], [4, 5, 6].map(Some));
    let point = of("x y z diameter tx ty tz", false);
    assert!(!point.fills(RADIUS) && !point.fills(TANGENT) && !point.diameters);
    let both = of("x y z diameter radius", true);
    assert_eq!((both.columns[RADIUS], both.diameters), (Some(4), false));
}

#[test]
fn coordinates_in_a_texture_have_many_names() {
    for (names, found) in
        [("x y z t s", [4, 3]), ("x y z u v", [3, 4]), ("x y z u v texture_v texture_u", [6, 5])]
    {
        let mut layout = layout(names, Scalar::F32);
        assert!(!layout.fills(TEXTURE), "{names}: without a texture they are none");
        layout.find_texture(&vertex(names, Scalar::F32));
        assert_eq!(layout.columns[TEXTURE..MATERIAL], found.map(Some), "{names}");
    }
    let mut half = layout("x y z u t", Scalar::F32);
    half.find_texture(&vertex("x y z u t", Scalar::F32));
    assert!(!half.fills(TEXTURE));
}

#[test]
fn names_are_found_in_any_order() {
    let layout = layout("radius z normal_z y x normal_x b g r quality normal_y", Scalar::F32);
    assert_eq!(layout.columns[..AXES], [4, 3, 1, 5, 10, 2, 0, 8, 7, 6].map(Some));
    assert!(!layout.uses(9) && layout.uses(10));
}

#[test]
fn colours_of_other_integers_are_left_alone() {
    assert_eq!(layout("x y z red green blue", Scalar::I32).colour, None);
    let half = layout("x y z red green r g b", Scalar::U16);
    assert_eq!((half.colour, half.columns[COLOUR]), (Some(Colour::Rgb([Scalar::U16; 3])), Some(5)));
}

#[test]
fn a_value_is_a_radius_beside_normals_alone() {
    assert_eq!(layout("x y z nx ny nz value", Scalar::F32).columns[RADIUS], Some(6));
    assert_eq!(layout("x y z nx ny nz value radius", Scalar::F32).columns[RADIUS], Some(7));
    assert!(!layout("x y z value", Scalar::F32).fills(RADIUS));
}

#[test]
fn shapes_need_every_part() {
    let gaussian = "x y z scale_0 scale_1 rot_0 rot_1 rot_2 rot_3";
    assert_eq!(layout(gaussian, Scalar::F32).shape, Shape::Gaussian(2));
    assert_eq!(layout(&format!("{gaussian} scale_2"), Scalar::F32).shape, Shape::Gaussian(3));
    assert_eq!(layout(&gaussian.replace("rot_3", "rot"), Scalar::F32).shape, Shape::Circle);
    assert_eq!(layout("x y z ux uy uz vx vy vz", Scalar::F32).shape, Shape::Axes);
    assert_eq!(layout("x y z ux uy uz vx vy", Scalar::F32).shape, Shape::Circle);
    assert!(!layout(&format!("{gaussian} radius"), Scalar::F32).uses(9), "its scales are the radius");
    assert!(layout("x y z ux uy uz vx vy vz radius", Scalar::F32).uses(9));
}

#[test]
fn clip_lines_need_a_plane_and_every_part() {
    let lines = "clip0x clip0y clip0z clip0d clip1x clip1y clip1z clip1d clip_concave";
    let both = layout(&format!("x y z nx ny nz {lines}"), Scalar::F32);
    assert_eq!(both.columns[CLIPS..WEIGHT], [6, 7, 8, 9, 10, 11, 12, 13, 14].map(Some));
    assert!(!layout(&format!("x y z {lines}"), Scalar::F32).has_clips(), "no normals");
    let axes = layout(&format!("x y z ux uy uz vx vy vz {lines}"), Scalar::F32);
    assert!(axes.has_clips() && axes.fills(CONCAVE));
    let second = layout(&format!("x y z nx ny nz {}", lines.replace("clip0d", "d")), Scalar::F32);
    assert!(!second.fills(CLIPS) && second.fills(CLIPS + 4) && second.fills(CONCAVE));
    let none = lines.replace("clip0x", "a").replace("clip1y", "b");
    let none = layout(&format!("x y z nx ny nz {none}"), Scalar::F32);
    assert!(!none.has_clips() && !none.fills(CONCAVE));
}

#[test]
fn weights_need_discs_and_corners_need_weights() {
    let corners = CORNER_NAMES.join(" ");
    let both = layout(&format!("x y z nx ny nz radius {WEIGHT_NAME} {corners}"), Scalar::F32);
    assert_eq!(both.columns[WEIGHT..TANGENT], [7, 8, 9, 10, 11].map(Some));
    let missing = format!("x y z nx ny nz radius {WEIGHT_NAME} {}", corners.replace('3', "4"));
    let one = layout(&missing, Scalar::F32);
    assert!(one.fills(WEIGHT) && !one.fills(CORNERS));
    assert!(!layout(&format!("x y z nx ny nz radius {corners}"), Scalar::F32).fills(CORNERS));
    assert!(!layout(&format!("x y z nx ny nz {WEIGHT_NAME}"), Scalar::F32).fills(WEIGHT), "no radius");
}

#[test]
fn the_chosen_scalar_may_be_any_number() {
    let cloud = vertex("x y z quality", Scalar::F32);
    assert_eq!(Layout::of(&cloud, &chosen("quality"), false).unwrap().columns[SCALAR], Some(3));
    let cause = Layout::of(&cloud, &chosen("height"), false).unwrap_err().to_string();
    assert!(cause.contains("`height`: choose one of `x`, `y`, `z`, `quality`"), "{cause}");
    let many: String = (0..50_000).map(|i| format!(" p{i}")).collect();
    let cause = Layout::of(&vertex(&format!("x y z{many}"), Scalar::F32), &chosen("height"), false)
        .unwrap_err()
        .to_string();
    assert!(cause.ends_with("`p3`, `p4` and 49995 more"), "{cause}");
}

#[test]
fn errors_name_missing_properties() {
    let cases =
        [("x y nx ny nz radius", "no x y z"), ("packed_position packed_scale", "compressed 3D Gaussians")];
    for (names, expected) in cases {
        let cause =
            Layout::of(&vertex(names, Scalar::F32), &ReadOptions::default(), false).unwrap_err().to_string();
        assert!(cause.contains(expected), "{names}: {cause}");
    }
}

#[test]
fn a_list_is_no_coordinate() {
    let mut element = vertex("x y z nx ny nz radius", Scalar::F32);
    element.properties[6].kind = Kind::List { length: Scalar::U8, item: Scalar::F32 };
    assert!(!Layout::of(&element, &ReadOptions::default(), false).unwrap().fills(RADIUS));
}
