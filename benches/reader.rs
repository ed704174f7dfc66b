//! The PLY reader alone, from the page cache: bytes per second.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;
use surfel::formats;

criterion_group!(benches, reader);
criterion_main!(benches);

fn reader(criterion: &mut Criterion) {
    let folder = tempfile::tempdir().expect("there is room for temporary files");
    let mut group = criterion.benchmark_group("reader");
    group.sample_size(10).sampling_mode(SamplingMode::Flat);
    group.warm_up_time(Duration::from_secs(1)).measurement_time(Duration::from_secs(3));
    for (name, path) in inputs(folder.path()) {
        let size = path.metadata().expect("the file is there").len();
        group.throughput(Throughput::Bytes(size));
        let read = || formats::read(&path, &Default::default(), &()).expect("the file is read");
        group.bench_function(name, |bencher| bencher.iter_with_large_drop(read));
    }
    group.finish();
}

/// Five million coloured points with normals in 135 MB, fewer points as text, and a mesh if it is present.
fn inputs(folder: &Path) -> Vec<(&'static str, PathBuf)> {
    let mut inputs = vec![
        ("binary-5m", write(&folder.join("binary.ply"), 5_000_000, binary())),
        ("ascii-300k", write(&folder.join("ascii.ply"), 300_000, ascii())),
    ];
    let dragon = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/stanford/dragon/dragon_vrip.ply");
    if dragon.exists() {
        inputs.push(("dragon", dragon))
    } else {
        eprintln!("SKIPPED: there is no {}", dragon.display())
    }
    inputs
}

/// One record: x y z nx ny nz, red green blue.
type Record = fn(&mut BufWriter<std::fs::File>, [f32; 6], [u8; 3]) -> std::io::Result<()>;

fn write(path: &Path, count: u32, (format, record): (&str, Record)) -> PathBuf {
    let mut out = BufWriter::new(std::fs::File::create(path).expect("the file is made"));
    let floats = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    let codes = ["red", "green", "blue"].map(|name| format!("property uchar {name}\n")).concat();
    let mut all = || {
        write!(out, "ply\nformat {format} 1.0\nelement vertex {count}\n{floats}{codes}end_header\n")?;
        (0..count).try_for_each(|i| {
            // A spiral on the sphere: all numbers have many digits.
            let z = 2.0 * (i as f32 + 0.5) / count as f32 - 1.0;
            let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
            let (x, y) = ((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin);
            record(&mut out, [3.0 * x, 3.0 * y, 3.0 * z, x, y, z], [i as u8, (i >> 8) as u8, (i >> 16) as u8])
        })?;
        out.flush()
    };
    all().expect("the file is written");
    path.to_owned()
}

const fn binary() -> (&'static str, Record) {
    ("binary_little_endian", |out, floats, codes| {
        floats.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()))?;
        out.write_all(&codes)
    })
}

const fn ascii() -> (&'static str, Record) {
    ("ascii", |out, [x, y, z, nx, ny, nz], [r, g, b]| writeln!(out, "{x} {y} {z} {nx} {ny} {nz} {r} {g} {b}"))
}
