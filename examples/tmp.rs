use glam::*; use surfel::{*, geometry::*, vk::*};
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let bytes = std::fs::read(&a[1]).unwrap();
    let frames: usize = a[2].parse().unwrap();
    let size: u32 = a[3].parse().unwrap();
    let validate = a.get(4).map(|s| s=="v").unwrap_or(false);
    let at = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let mut s = Surfels::default(); let mut cols = vec![];
    for r in bytes[at..].chunks_exact(31) {
        let f = |i: usize| f32::from_le_bytes(r[i..i+4].try_into().unwrap());
        s.positions.push(Vec3::new(f(0), f(4), f(8))); s.normals.push(Vec3::new(f(12), f(16), f(20)).normalize());
        cols.push([r[24], r[25], r[26], 255]); s.radii.push(f(27));
    }
    s.colours = Some(Colours::Srgb8(cols)); s.sort_morton();
    let dev = Device::open(&DeviceOptions { validate, ..Default::default() }).unwrap();
    println!("{:?}", dev);
    let scene = Scene::upload(&dev, &s).unwrap();
    let eye = 3.5 * DVec3::new(1.0, 0.8, 1.6).normalize();
    let cam = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 45f64.to_radians(), 1.0, 0.01).unwrap();
    let mut st = Settings::default(); st.shading = settings::Shading::Colour; st.background = Some([1.0;3]);
    if let Some(l) = a.get(5) { st.lowpass = l.parse().unwrap(); }
    if let Some(l) = a.get(6) { if l == "lit" { st.shading = settings::Shading::Lit } if l == "back" { st.cull = settings::Cull::Back } }
    let profile = a.get(7).is_some();
    let mut r = Renderer::new(&dev, RenderOptions { size: [size; 2], profile, count: profile, ..Default::default() }).unwrap();
    for _ in 0..frames { let t = std::time::Instant::now(); let rep = r.render(&scene, &cam, &st).unwrap(); if profile { println!("{:.1} ms {:?}", t.elapsed().as_secs_f64()*1e3, rep); } }
    let (p, _) = r.render_picture(&scene, &cam, &st).unwrap();
    let img: Vec<u8> = p.colour.iter().flat_map(|c| [0,1,2].map(|k| { let x = c[k]; ((if x <= 0.0031308 {12.92*x} else {1.055*x.powf(1.0/2.4)-0.055})*255.0+0.5) as u8 })).collect();
    image::save_buffer("/tmp/out.png", &img, size, size, image::ColorType::Rgb8).unwrap();
    for m in dev.validation_messages() { println!("VAL {m}"); }
    println!("{:?}", dev.usage());
}
