//! The readers alone, from the page cache: bytes per second. Without arguments of PLY files, otherwise of the given ones:
//! `cargo bench --bench reader -- scan.laz`. With `--once FILE` it reads one file once and prints times and memory as JSON, for
//! `benches/peers/readers`.

mod support;

use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use support::{Result, Row, Table, whole};
use surfel::bench::stopwatch::{Sample, timed};
use surfel::formats;
use surfel::geometry::{Cloud, Colours};

fn main() -> Result<()> {
    let folder = tempfile::tempdir()?;
    let given: Vec<PathBuf> =
        std::env::args_os().skip(1).filter(|name| name != "--bench").map(PathBuf::from).collect();
    if let [first, path] = &given[..]
        && first == Path::new("--once")
    {
        return once(path);
    }
    let table = Table::new("reading a file from the page cache", None);
    let inputs = if given.is_empty() {
        inputs(folder.path())?
    } else {
        given.into_iter().map(|path| (path.display().to_string(), path)).collect()
    };
    for (name, path) in inputs {
        let bytes = path.metadata()?.len() as usize;
        let read = whole(|| Ok(formats::read(&path, &Default::default(), &())?));
        table.compare(vec![Row::new(name, read).of(bytes, "B/s")])?;
    }
    Ok(())
}

/// Reads a file once; prints the times in s and the bytes of the result and of the memory at its peak.
fn once(path: &Path) -> Result<()> {
    let before = memory("VmRSS")?;
    let (loaded, Sample { wall, cpu, .. }) = timed(|| formats::read(path, &Default::default(), &()))?;
    let Cloud { positions, normals, radii, colours, .. } = &loaded.cloud;
    let colours = match colours {
        None => 0,
        Some(Colours::Srgb8(codes)) => size_of_val(&codes[..]),
        Some(Colours::Linear(linear)) => size_of_val(&linear[..]),
    };
    let others = normals.as_ref().map_or(0, |all| size_of_val(&all[..]))
        + radii.as_ref().map_or(0, |all| size_of_val(&all[..]));
    let measured = serde_json::json!({
        "wall": wall / 1e3,
        "cpu": cpu / 1e3,
        "peak": memory("VmHWM")?.saturating_sub(before),
        "result": size_of_val(&positions[..]) + colours + others,
        "points": positions.len(),
    });
    println!("{measured}");
    Ok(())
}

/// A line of the process's status, bytes.
fn memory(name: &str) -> Result<usize> {
    let text = std::fs::read_to_string("/proc/self/status")?;
    let line = text.lines().find(|line| line.starts_with(name)).ok_or("there is no such line")?;
    Ok(line.split_whitespace().nth(1).ok_or("it has no value")?.parse::<usize>()? * 1024)
}

/// Five million coloured points with normals in 135 MB, fewer points as text, and a mesh if it is present.
fn inputs(folder: &Path) -> Result<Vec<(String, PathBuf)>> {
    let mut inputs = vec![
        ("binary, 5 M points".into(), write(folder.join("binary.ply"), 5_000_000, binary())?),
        ("ASCII, 300 k points".into(), write(folder.join("ascii.ply"), 300_000, ascii())?),
    ];
    let dragon = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data/stanford/dragon/dragon_vrip.ply");
    if dragon.exists() {
        inputs.push(("dragon".into(), dragon))
    } else {
        eprintln!("SKIPPED: there is no {}", dragon.display())
    }
    Ok(inputs)
}

/// One record: x y z nx ny nz, red green blue.
type Record = fn(&mut BufWriter<std::fs::File>, [f32; 6], [u8; 3]) -> std::io::Result<()>;

fn write(path: PathBuf, count: u32, (format, record): (&str, Record)) -> Result<PathBuf> {
    let mut out = BufWriter::new(std::fs::File::create(&path)?);
    let floats = ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property float {name}\n")).concat();
    let codes = ["red", "green", "blue"].map(|name| format!("property uchar {name}\n")).concat();
    write!(out, "ply\nformat {format} 1.0\nelement vertex {count}\n{floats}{codes}end_header\n")?;
    for i in 0..count {
        // A spiral on the sphere: all numbers have many digits.
        let z = 2.0 * (i as f32 + 0.5) / count as f32 - 1.0;
        let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
        let (x, y) = ((1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin);
        record(&mut out, [3.0 * x, 3.0 * y, 3.0 * z, x, y, z], [i as u8, (i >> 8) as u8, (i >> 16) as u8])?;
    }
    out.flush()?;
    Ok(path)
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
