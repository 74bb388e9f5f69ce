//! Colours that are read as an order, also by the colour-blind and on a grey printer.

/// Red, green and blue, 0 to 1, as on the screen (sRGB).
pub type Rgb = [f64; 3];

/// From nothing to too much: lightness falls evenly from pale sand to deep violet.
const VIOLATION: [Rgb; 6] = [
    [0.965, 0.945, 0.890],
    [0.980, 0.800, 0.560],
    [0.950, 0.590, 0.390],
    [0.800, 0.340, 0.420],
    [0.520, 0.150, 0.450],
    [0.230, 0.055, 0.330],
];

/// From -1 to 1: red (compression, shorter) over grey to blue (tension, longer); both ends equally dark.
const DIVERGING: [Rgb; 5] =
    [[0.640, 0.070, 0.130], [0.880, 0.470, 0.360], [0.760, 0.770, 0.780], [0.400, 0.610, 0.840], [0.090, 0.260, 0.600]];

/// A surface without a value.
pub const PLAIN: Rgb = [0.80, 0.83, 0.86];

/// How numbers become colours, with what the legend says of them.
#[derive(Clone, Debug)]
pub struct Scale {
    /// What is shown.
    pub title: String,
    /// The unit of the numbers at the ticks.
    pub unit: &'static str,
    /// The numbers at the ends, in that unit; what lies beyond has the end's colour.
    pub range: [f64; 2],
    pub is_diverging: bool,
    /// A mark on the scale with its name: the tolerance.
    pub mark: Option<(f64, String)>,
    /// What the ends mean, where they need words: at the upper, at the lower.
    pub end_words: [&'static str; 2],
}

impl Scale {
    /// The colour of `value`, in the scale's unit.
    pub fn colour(&self, value: f64) -> Rgb {
        let [low, high] = self.range;
        self.at((value - low) / (high - low))
    }

    /// The colour at a share of the scale's length from its lower end.
    pub fn at(&self, share: f64) -> Rgb {
        if self.is_diverging { interpolate(&DIVERGING, share) } else { interpolate(&VIOLATION, share) }
    }
}

fn interpolate(stops: &[Rgb], share: f64) -> Rgb {
    let position = share.clamp(0.0, 1.0) * (stops.len() - 1) as f64;
    let index = (position as usize).min(stops.len() - 2);
    let rest = position - index as f64;
    std::array::from_fn(|i| stops[index][i] + rest * (stops[index + 1][i] - stops[index][i]))
}

/// "#rrggbb", with every channel multiplied by `light`.
pub fn hex(colour: Rgb, light: f64) -> String {
    let [r, g, b] = colour.map(|channel| (255.0 * (channel * light).clamp(0.0, 1.0)).round() as u8);
    format!("#{r:02x}{g:02x}{b:02x}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// CIE lightness, 0 to 100 (IEC 61966-2-1 for the transfer curve).
    fn lightness(colour: Rgb) -> f64 {
        let linear = colour.map(|c| if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) });
        let y = 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
        116.0 * y.cbrt() - 16.0
    }

    #[test]
    fn lightness_falls_evenly_along_violations() {
        let steps: Vec<f64> = (0..=50).map(|i| lightness(interpolate(&VIOLATION, f64::from(i) / 50.0))).collect();
        let falls: Vec<f64> = steps.windows(2).map(|pair| pair[0] - pair[1]).collect();
        assert!(steps[0] > 90.0 && steps[50] < 20.0);
        assert!(falls.iter().all(|fall| (0.5..3.0).contains(fall)), "{falls:?}");
    }

    #[test]
    fn both_ends_of_strain_are_equally_dark_and_the_middle_is_light() {
        let [low, middle, high] = [0.0, 0.5, 1.0].map(|share| lightness(interpolate(&DIVERGING, share)));
        assert!((low - high).abs() < 6.0 && middle > 75.0, "{low} {middle} {high}");
    }

    #[test]
    fn values_beyond_the_ends_have_the_ends_colours() {
        let scale = Scale {
            title: String::new(),
            unit: "%",
            range: [0.0, 1.0],
            is_diverging: false,
            mark: None,
            end_words: ["", ""],
        };
        assert_eq!(
            (hex(scale.colour(-3.0), 1.0), hex(scale.colour(7.0), 1.0)),
            (hex(VIOLATION[0], 1.0), hex(VIOLATION[5], 1.0))
        );
        assert_eq!(hex(scale.colour(0.0), 1.0), "#f6f1e3");
        assert_eq!(hex([2.0, -1.0, f64::NAN], 1.0), "#ff0000");
    }
}
