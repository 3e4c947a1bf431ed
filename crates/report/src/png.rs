//! Pictures as PNG, with a font that is always there. A feature that is off: `png`.

/// Whether this build draws PNG.
///
/// # Errors
/// How one is made that does.
pub fn can_draw_png() -> Result<(), &'static str> {
    match cfg!(feature = "png") {
        true => Ok(()),
        false => Err("this build draws no PNG: one with the feature `png` does (cargo install \
                      --path . --features png); SVG is the same picture"),
    }
}

/// An SVG of this package as PNG, of twice as many pixels. The same picture gives the same bytes.
///
/// # Errors
/// The build draws none, or the picture is too large.
#[cfg(not(feature = "png"))]
pub fn png(_: &str) -> Result<Vec<u8>, String> {
    can_draw_png().map(|()| Vec::new()).map_err(str::to_owned)
}

/// An SVG of this package as PNG, of twice as many pixels. The same picture gives the same bytes.
///
/// # Errors
/// The build draws none, or the picture is too large.
#[cfg(feature = "png")]
pub fn png(svg: &str) -> Result<Vec<u8>, String> {
    use resvg::{tiny_skia, usvg};
    use std::sync::Arc;
    const PIXELS: f32 = 2.0;
    let mut options =
        usvg::Options { font_family: "DejaVu Sans".to_owned(), ..usvg::Options::default() };
    let fonts = Arc::make_mut(&mut options.fontdb);
    for font in [
        &include_bytes!("../fonts/DejaVuSans.ttf")[..],
        &include_bytes!("../fonts/DejaVuSans-Bold.ttf")[..],
    ] {
        fonts.load_font_data(font.to_vec());
    }
    fonts.set_sans_serif_family("DejaVu Sans");
    let tree = usvg::Tree::from_str(svg, &options).map_err(|error| error.to_string())?;
    let [wide, tall] =
        [tree.size().width(), tree.size().height()].map(|length| (PIXELS * length).ceil() as u32);
    let mut pixels =
        tiny_skia::Pixmap::new(wide, tall).ok_or_else(|| format!("{wide} x {tall} pixels"))?;
    let larger = tiny_skia::Transform::from_scale(PIXELS, PIXELS);
    resvg::render(&tree, larger, &mut pixels.as_mut());
    pixels.encode_png().map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(not(feature = "png"))]
    #[test]
    fn a_build_without_png_says_how_to_get_one() {
        assert!(can_draw_png().expect_err("none").contains("--features png"));
        assert!(png("<svg/>").expect_err("none").contains("--features png"));
    }

    /// Size of a picture, by its head.
    #[cfg(feature = "png")]
    fn size(bytes: &[u8]) -> [u32; 2] {
        let number = |at: usize| u32::from_be_bytes(bytes[at..at + 4].try_into().expect("four"));
        [number(16), number(20)]
    }

    #[cfg(feature = "png")]
    #[test]
    fn pictures_have_their_words() {
        let labelled = |text: &str| {
            let mut svg = crate::svg::Svg::new([60.0, 20.0], "a");
            svg.label([2.0, 15.0], "start", "font-size=\"12\" fill=\"#000\"", text);
            png(&svg.finish()).expect("a picture")
        };
        let [empty, word, bytes] = ["", "q \u{2212}1", "q \u{2212}1"].map(labelled);
        assert!(word.starts_with(b"\x89PNG") && size(&word) == [120, 40]);
        assert!(word != empty && word == bytes, "words are drawn, and always alike");
        assert!(png("<svg").is_err());
    }
}
