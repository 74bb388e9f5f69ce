//! From SVG to PNG, with a font that the program carries: no font of the machine is asked for.

use std::sync::{Arc, OnceLock};

use anyhow::{Context, Result};
use resvg::tiny_skia::{Color, Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb};

/// The family that pictures name first; SVG viewers without it fall back to what they have.
pub const FONT_FAMILY: &str = "Noto Sans, Helvetica, Arial, sans-serif";

/// Pixels of the PNG per unit of the SVG.
const SCALE: f32 = 1.5;

fn fonts() -> Arc<fontdb::Database> {
    static FONTS: OnceLock<Arc<fontdb::Database>> = OnceLock::new();
    let fonts = FONTS.get_or_init(|| {
        let mut fonts = fontdb::Database::new();
        fonts.load_font_data(ttf_noto_sans::REGULAR.to_vec());
        fonts.load_font_data(ttf_noto_sans::BOLD.to_vec());
        fonts.set_sans_serif_family("Noto Sans");
        Arc::new(fonts)
    });
    fonts.clone()
}

/// The picture as PNG on white.
pub fn png(svg: &str) -> Result<Vec<u8>> {
    png_at(svg, SCALE)
}

/// The same with so many pixels per unit of the SVG.
pub fn png_at(svg: &str, scale: f32) -> Result<Vec<u8>> {
    rendered(svg, scale)?.encode_png().context("the picture could not be compressed")
}

/// The same, its channels rounded to 64 levels: where a surface is of many faces the file is half as large, and looks the same.
pub fn small_png_at(svg: &str, scale: f32) -> Result<Vec<u8>> {
    let mut pixels = rendered(svg, scale)?;
    // All pixels are opaque. 255 stays 255.
    let rounded = |channel: u8| ((u16::from(channel) + 2) / 4 * 4).min(255) as u8;
    for channels in pixels.data_mut().chunks_exact_mut(4) {
        channels[..3].iter_mut().for_each(|channel| *channel = rounded(*channel));
    }
    pixels.encode_png().context("the picture could not be compressed")
}

/// The picture on white as rows of red, green and blue; with its width and height.
pub fn rgb_at(svg: &str, scale: f32) -> Result<(u32, u32, Vec<u8>)> {
    let pixels = rendered(svg, scale)?;
    // All pixels are opaque.
    let colours = pixels.data().chunks_exact(4).flat_map(|channels| [channels[0], channels[1], channels[2]]).collect();
    Ok((pixels.width(), pixels.height(), colours))
}

fn rendered(svg: &str, scale: f32) -> Result<Pixmap> {
    let options = Options { fontdb: fonts(), font_family: "Noto Sans".to_owned(), ..Options::default() };
    let tree = Tree::from_str(svg, &options).context("the picture could not be laid out")?;
    let size = tree.size();
    let (width, height) = ((size.width() * scale).ceil() as u32, (size.height() * scale).ceil() as u32);
    let mut pixels = Pixmap::new(width, height).context("the picture has no size")?;
    pixels.fill(Color::WHITE);
    resvg::render(&tree, Transform::from_scale(scale, scale), &mut pixels.as_mut());
    Ok(pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_drawn_without_fonts_of_the_machine() {
        let svg = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 40' width='100' height='40'>\
                   <text x='5' y='30' font-size='30' font-family='Noto Sans, sans-serif' fill='#000000'>%i</text></svg>";
        let pixels = Pixmap::decode_png(&png(svg).unwrap()).unwrap();
        assert_eq!((pixels.width(), pixels.height()), (150, 60));
        let dark = pixels.pixels().iter().filter(|pixel| pixel.red() < 100).count();
        assert!(dark > 150, "{dark} dark pixels");
        assert!(fonts().faces().all(|face| face.families[0].0 == "Noto Sans"));
    }
}
