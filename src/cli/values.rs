//! Parsers of the values of options.

use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::{ContextKind, ContextValue};
use glam::DVec3;
use std::ffi::OsStr;
use std::ops::RangeInclusive;
use std::str::FromStr;
use surfel::estimate::Scanner;
use surfel::formats::class_name;
use surfel::geometry::ValueRange;
use surfel::geometry::srgb;
use surfel::settings::methods::Method;
use surfel::settings::splatting::Kernel;
use surfel::settings::{Choice, Settings};

/// Parses `WxH`, px.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let side = |text: &str| text.parse().ok().filter(|&side: &u32| side > 0);
    let sides = text.split_once('x').and_then(|(width, height)| Some([side(width)?, side(height)?]));
    sides.ok_or_else(|| "give WIDTHxHEIGHT in px, both whole numbers above 0, for example 1024x768".into())
}

/// Parses `X,Y,Z`.
pub fn vector(text: &str) -> Result<DVec3, String> {
    let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    match numbers.as_deref() {
        Some(&[x, y, z]) => Ok(DVec3::new(x, y, z)),
        _ => Err("give three numbers as X,Y,Z without spaces, for example 0,1.5,-2".into()),
    }
}

/// Parses `XMIN,YMIN,ZMIN,XMAX,YMAX,ZMAX`, or `XMIN,YMIN,XMAX,YMAX` for any z.
pub fn bounds(text: &str) -> Result<[DVec3; 2], String> {
    let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    let bounds = match numbers.as_deref() {
        Some(&[x, y, z, x1, y1, z1]) => Some([DVec3::new(x, y, z), DVec3::new(x1, y1, z1)]),
        Some(&[x, y, x1, y1]) => {
            Some([DVec3::new(x, y, f64::NEG_INFINITY), DVec3::new(x1, y1, f64::INFINITY)])
        }
        _ => None,
    };
    bounds.filter(|[min, max]| min.cmple(*max).all()).ok_or_else(|| {
        "give XMIN,YMIN,XMAX,YMAX or XMIN,YMIN,ZMIN,XMAX,YMAX,ZMAX without spaces, minima at most as large as maxima, for example \
         --bounds=-10,0,10,20"
            .into()
    })
}

/// Parses `auto`, `file` or the position of a scanner.
pub fn scanner(text: &str) -> Result<Scanner, String> {
    match text {
        "auto" => Ok(Scanner::Auto),
        "file" => Ok(Scanner::OfFile),
        _ => vector(text).map(Scanner::At).map_err(|_| "give auto, file or X,Y,Z".into()),
    }
}

/// Parses a vector that is not 0; returns the unit vector.
pub fn direction(text: &str) -> Result<DVec3, String> {
    vector(text)?.try_normalize().ok_or_else(|| "it is zero: give a direction such as 0,0,1".into())
}

/// Parses a number.
pub fn number<T: FromStr>(text: &str) -> Result<T, String> {
    text.trim().parse().map_err(|_| "give a number, for example 0.5".into())
}

/// Parses a whole number in a range.
pub fn whole<T: TryFrom<u64>>(
    range: RangeInclusive<u64>,
) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync {
    move |text: &str| {
        let number = text.trim().parse().ok().filter(|number| range.contains(number));
        number.and_then(|number| number.try_into().ok()).ok_or_else(|| match (range.start(), range.end()) {
            (1, end) if *end >= u32::MAX.into() => "give a whole number above 0".into(),
            (start, end) => format!("give a whole number from {start} to {end}"),
        })
    }
}

/// Parses a class by its number or by its name, in which `-` may stand for a space.
pub fn class(text: &str) -> Result<u8, String> {
    let name = text.trim().to_lowercase().replace(['-', '_'], " ");
    let named: Vec<u8> =
        (0..=u8::MAX).filter(|class| class_name((*class).into()) == Some(name.as_str())).collect();
    match (name.parse(), &named[..]) {
        (Ok(class), _) => Ok(class),
        (Err(_), &[class]) => Ok(class),
        _ => Err(
            "give numbers up to 255 such as 2,6, or names such as ground: `surfel info` lists the classes"
                .into(),
        ),
    }
}

/// Parses a finite number above 0.
pub fn positive<T: FromStr + Into<f64> + Copy>(text: &str) -> Result<T, String> {
    let number = text.trim().parse().ok();
    let usable = number.filter(|&number: &T| number.into() > 0.0 && number.into().is_finite());
    usable.ok_or_else(|| "give a number above 0".into())
}

/// Parses an angle between 0 and 180 degrees.
pub fn angle<T: FromStr + Into<f64> + Copy>(text: &str) -> Result<T, String> {
    let angle = text.trim().parse().ok().filter(|&angle: &T| angle.into() > 0.0 && angle.into() < 180.0);
    angle.ok_or_else(|| "give an angle above 0 and below 180".into())
}

/// What points are coloured by.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBy {
    /// Name of a property or a quantity.
    pub name: String,
    /// The values at both ends of the colour map, if they are given.
    pub range: Option<ValueRange>,
}

/// Parses `NAME` or `NAME:MIN,MAX`. Names may contain colons: only text with a comma after the last colon is a range.
pub fn colour_by(text: &str) -> Result<ColourBy, String> {
    let wrong = || "give NAME or NAME:MIN,MAX with MIN below MAX, for example intensity:0,255".to_owned();
    let number = |text: &str| text.trim().parse().ok().filter(|value: &f64| value.is_finite());
    let (name, range) = match text.rsplit_once(':').map(|(name, range)| (name, range.split_once(','))) {
        Some((name, Some((min, max)))) => {
            let (min, max) = number(min).zip(number(max)).filter(|(min, max)| min < max).ok_or_else(wrong)?;
            (name, Some(ValueRange { min, max }))
        }
        _ => (text, None),
    };
    if name.is_empty() { Err(wrong()) } else { Ok(ColourBy { name: name.into(), range }) }
}

/// Reconstruction filter of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Filter {
    /// The Gaussian low-pass filter of EWA splatting
    Gaussian,
    /// The mean over the pixel
    Box,
    /// A single ray through the pixel's centre
    Point,
}

/// Background of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Background {
    /// Nothing: all channels 0.
    Transparent,
    /// A colour, linear.
    Opaque([f32; 3]),
}

impl Background {
    /// The value of [`surfel::Settings::background`].
    pub fn linear(self) -> Option<[f32; 3]> {
        match self {
            Self::Transparent => None,
            Self::Opaque(colour) => Some(colour),
        }
    }
}

/// Parses `transparent`, or an [`opaque`] colour.
pub fn background(text: &str) -> Result<Background, String> {
    match text {
        "transparent" => Ok(Background::Transparent),
        _ => opaque(text)
            .map(Background::Opaque)
            .map_err(|error| error.replacen("give ", "give transparent, or ", 1)),
    }
}

/// Parses `R,G,B`, 8-bit sRGB codes as in the PNG, or an opaque CSS colour; returns linear light.
pub fn opaque(text: &str) -> Result<[f32; 3], String> {
    let codes: Option<Vec<u8>> = text.split(',').map(|code| code.trim().parse().ok()).collect();
    let css = || csscolorparser::parse(text).ok().filter(|colour| colour.a == 1.0);
    let code = match codes.as_deref() {
        Some(&[r, g, b]) => Some([r, g, b]),
        _ => css().map(|colour| colour.to_rgba8()).map(|[r, g, b, _]| [r, g, b]),
    };
    let linear = |codes: [u8; 3]| codes.map(|code| srgb::decode(f64::from(code) / 255.0) as f32);
    code.map(linear).ok_or_else(|| {
        "give R,G,B, each from 0 to 255 (sRGB), for example 255,255,255, or a CSS colour: #fff, white".into()
    })
}

/// Parses a method by its name.
pub fn method() -> impl TypedValueParser<Value = Method> {
    let presets = Method::CHOICES.map(|method| PossibleValue::new(method.name).help(method.paper));
    MethodParser(PossibleValuesParser::new(presets))
}

/// A parser of methods by name, which suggests the first one that has a wrong name in its own.
#[derive(Clone)]
struct MethodParser(PossibleValuesParser);

impl TypedValueParser for MethodParser {
    type Value = Method;

    fn parse_ref(
        &self,
        command: &clap::Command,
        option: Option<&clap::Arg>,
        text: &OsStr,
    ) -> Result<Method, clap::Error> {
        let name = self.0.parse_ref(command, option, text).map_err(|mut error| {
            let part = text.to_string_lossy();
            let meant = Method::CHOICES.into_iter().find(|method| method.name.contains(&*part));
            if let Some(method) = meant.filter(|_| !part.is_empty()) {
                error.insert(ContextKind::SuggestedValue, ContextValue::String(method.name.into()));
            }
            error
        })?;
        Ok(Method::named(&name).unwrap_or(Method::ALL[0]))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        self.0.possible_values()
    }
}

/// Parses one of all choices by its name.
pub fn choice<T: Choice>() -> impl TypedValueParser<Value = T> {
    one_of(T::ALL)
}

/// Parses one of these choices by its name.
pub fn one_of<T: Choice>(all: &[T]) -> impl TypedValueParser<Value = T> {
    let value = |one: &T| PossibleValue::new(one.name()).aliases(one.names()).help(one.about());
    PossibleValuesParser::new(all.iter().map(value))
        .try_map(|name| T::named(&name).ok_or("there is no such choice"))
}

/// Parses `gaussian`, or `confetti:A,N`.
pub fn kernel(text: &str) -> Result<Kernel, String> {
    let number = |text: &str| text.trim().parse().ok();
    let numbers = |text: &str| text.split_once(',').and_then(|(a, n)| number(a).zip(number(n)));
    match text.split_once(':') {
        None if text == "gaussian" => Some(Kernel::Gaussian),
        Some(("confetti", rest)) => numbers(rest).map(|(a, n)| Kernel::Confetti { a, n }),
        _ => None,
    }
    .ok_or_else(|| "give gaussian, or confetti:A,N, for example confetti:6,3".into())
}

/// Parses the filter of pixels: its variance, px², 0 for none.
pub fn pixel_filter(text: &str) -> Result<f32, String> {
    match text.split_once(':') {
        None if text == "none" => Some(0.0),
        None if text == "gaussian" => Some(Settings::DEFAULT_PIXEL_FILTER),
        Some(("gaussian", variance)) => variance.trim().parse().ok(),
        _ => None,
    }
    .ok_or_else(|| "give none, gaussian, or gaussian:VARIANCE_PX2, for example gaussian:0.5".into())
}

/// Additional layer of an EXR file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Layer {
    /// Unit normals in world space, as channels N.X, N.Y, N.Z
    Normal,
    /// Distance from the eye along the view, as channel Z
    Depth,
    /// Number of the point that is shown, as channel id of 32-bit whole numbers; by pull-push and pull-push-paper
    Id,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_exactly_or_refused() {
        assert_eq!(size("640x480"), Ok([640, 480]));
        for text in ["0x5", "5x0", "5", "5x5x5", "-1x5", "5x", "4294967296x1", "1e2x5"] {
            assert!(size(text).is_err(), "{text}");
        }
        assert_eq!(vector("1,-2.5, 3e2"), Ok(DVec3::new(1.0, -2.5, 300.0)));
        for text in ["1,2", "1,2,3,4", "1,2,x", "nan,0,0", "inf,0,0", ""] {
            assert!(vector(text).is_err(), "{text}");
        }
        let [low, high] = [f64::NEG_INFINITY, f64::INFINITY];
        let expected = [DVec3::new(-1.0, 2.0, low), DVec3::new(3.0, 2.0, high)];
        assert_eq!(bounds("-1,2,3,2"), Ok(expected));
        assert_eq!(bounds("1,2,3,4,5,6"), Ok([DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, 5.0, 6.0)]));
        for text in ["1,2,3", "1,2,3,4,5", "1,2,0,4", "1,2,3,4,5,2", "nan,0,1,1", "0,0,inf,1", ""] {
            assert!(bounds(text).is_err(), "{text}");
        }
        assert_eq!(background("transparent").map(Background::linear), Ok(None));
        assert_eq!(background("255,0,255").map(Background::linear), Ok(Some([1.0, 0.0, 1.0])));
        assert_eq!(background("white").map(Background::linear), Ok(Some([1.0; 3])));
        for text in ["256,0,0", "0.5,0,0", "oranje", "#fff8", "1,2", "-1,0,0"] {
            assert!(background(text).is_err(), "{text}");
        }
    }

    #[test]
    fn numbers_names_and_directions_are_read_or_refused() {
        assert_eq!((positive("1e-3"), positive("2")), (Ok(1e-3), Ok(2f32)));
        for text in ["0", "-1", "nan", "inf", "1e39", "", "x"] {
            assert!(positive::<f32>(text).is_err(), "{text}");
        }
        assert_eq!(
            [class("2"), class("Ground"), class("low-vegetation"), class("255")],
            [2, 2, 3, 255].map(Ok)
        );
        for text in ["", "reserved", "256", "-1", "grond"] {
            assert!(class(text).unwrap_err().contains("`surfel info` lists the classes"), "{text}");
        }
        let above = |text: &str, most| whole::<u32>(1..=most)(text).unwrap_err();
        assert_eq!([whole(1..=5)("5"), whole(1..=u64::MAX)("7")], [Ok(5), Ok(7u8)]);
        assert_eq!(above("0", u64::MAX), "give a whole number above 0");
        assert_eq!(above("1.5", 5), "give a whole number from 1 to 5");
        assert_eq!(above("5000000000", u64::MAX), "give a whole number above 0");
        assert_eq!((number("-0.5"), number::<f32>("x").is_err()), (Ok(-0.5), true));
        assert_eq!(direction("0,0,-5"), Ok(DVec3::NEG_Z));
        assert!(direction("0,0,0").is_err());
        let by = |name: &str, range| Ok(ColourBy { name: name.into(), range });
        assert_eq!(colour_by("intensity"), by("intensity", None));
        assert_eq!(colour_by("a:b"), by("a:b", None));
        assert_eq!(colour_by("a:b:-1,2.5"), by("a:b", Some(ValueRange { min: -1.0, max: 2.5 })));
        for text in ["", "a:1,1", "a:2,1", "a:1,2,3", "a:nan,2", "a:,", ":1,2"] {
            assert!(colour_by(text).is_err(), "{text}");
        }
    }
}
