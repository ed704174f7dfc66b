//! Pull–push of ribbons, tubes and polygons: the float64 reference against rays through the exact surface.

use glam::{DVec3, Vec3};
use surfel::pull_push::{PullPush, Rules};
use surfel::settings::{Settings, Shading};
use surfel::truth::{self, Filter, Options};
use surfel::{Picture, scenes};

/// How far, in units of the scene, a pixel may be from the surface that is seen.
const LEAK: f32 = 0.05;

/// What is wrong with a picture.
#[derive(Debug, Default)]
struct Faults {
    /// Pixels of the object.
    object: usize,
    /// Pixels that show nothing where the object is, and those of them whose eight neighbours show it, too.
    missing: usize,
    holes: usize,
    /// Pixels that show something where nothing is.
    extra: usize,
    /// Pixels that show what is behind, or in front of, what is seen.
    behind: usize,
    before: usize,
    /// Mean angle between the normals where neither holds, degrees.
    normal: f64,
    /// Mean distance of the colours there, linear.
    colour: f64,
}

fn faults(found: &Picture, exact: &Picture) -> Faults {
    let [width, height] = found.size.map(|side| side as i64);
    let covered = |picture: &Picture, x: i64, y: i64| {
        (0..width).contains(&x) && (0..height).contains(&y) && picture.colour[(y * width + x) as usize][3] > 0.5
    };
    let (mut faults, mut common) = (Faults::default(), 0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let i = (y * width + x) as usize;
        let [is, should] = [found, exact].map(|picture| covered(picture, x, y));
        faults.object += usize::from(should);
        faults.extra += usize::from(is && !should);
        faults.missing += usize::from(should && !is);
        let inner = (0..9).all(|k| covered(exact, x + k % 3 - 1, y + k / 3 - 1));
        faults.holes += usize::from(should && !is && inner);
        if is && should {
            let [depth, true_depth] = [found, exact].map(|picture| picture.depth.as_ref().unwrap()[i]);
            faults.behind += usize::from(depth > true_depth + LEAK);
            faults.before += usize::from(depth < true_depth - LEAK);
            if (depth - true_depth).abs() <= LEAK {
                let [a, b] =
                    [found, exact].map(|picture| Vec3::from(picture.normal.as_ref().unwrap()[i]).as_dvec3());
                // Sheets have two sides.
                faults.normal += a.angle_between(b).min(a.angle_between(-b)).to_degrees();
                let [a, b] = [found, exact].map(|picture| picture.colour[i].map(f64::from));
                faults.colour += DVec3::new(a[0] - b[0], a[1] - b[1], a[2] - b[2]).length();
                common += 1;
            }
        }
    }
    faults.normal /= common as f64;
    faults.colour /= common as f64;
    faults
}

fn write(picture: &Picture, name: &str) {
    if let Some(folder) = std::env::var_os("SURFEL_FIGURES") {
        let path = std::path::Path::new(&folder).join(name);
        surfel::io::image::write(picture, Shading::Lit, &surfel::io::image::Output::parse(path.as_os_str())).unwrap();
    }
}

fn compare(name: &str, size: [u32; 2]) -> [Faults; 2] {
    let model = scenes::model(name).unwrap();
    let surface = scenes::surface(name).unwrap();
    let camera = scenes::camera(name)
        .unwrap()
        .camera(f64::from(size[0]) / f64::from(size[1]), &surface.bounds())
        .unwrap();
    let settings = Settings { shading: Shading::Lit, ..Default::default() };
    let options = Options { filter: Filter::Point, ..Default::default() };
    let exact = truth::render(&*surface, &camera, &settings, size, &options, &()).unwrap().picture;
    let file = name.replace([':', '?', '&', '='], "-");
    write(&exact, &format!("{file}-exact.png"));
    [Rules::Paper, Rules::Robust].map(|rules| {
        let pull_push = PullPush { rules };
        let settings = Settings { pull_push: Some(pull_push), ..settings.clone() };
        let frame = surfel::reference::render(&model, &camera, size, &settings, &()).unwrap().to_picture();
        write(&frame, &format!("{file}-{}.png", rules.name()));
        let faults = faults(&frame, &exact);
        println!("{name} {size:?} {rules:?}: {faults:?}");
        faults
    })
}

#[test]
fn lines_and_polygons_are_near_the_truth() {
    for name in [
        "scene:ribbon?primitives=on&albedo=plain",
        "scene:ribbon?primitives=on&albedo=plain&width=0.1",
        "scene:helix?primitives=on&albedo=plain&segments=128",
        "scene:helix?primitives=on&albedo=plain&segments=400&turns=12",
        "scene:tree?primitives=on&segments=12",
        "scene:mixed?primitives=on&segments=200&points=50000",
    ] {
        compare(name, [512, 512]);
    }
}
