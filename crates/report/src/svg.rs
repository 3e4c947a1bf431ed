//! Elements of a picture as SVG text.

use super::camera::Vec2;

/// An SVG document that grows.
#[derive(Debug)]
pub(super) struct Svg {
    text: String,
    gradients: usize,
}

impl Svg {
    /// An empty picture of a size [px], with a white ground.
    pub(super) fn new(size: Vec2, title: &str) -> Self {
        let [w, h] = size.map(number);
        let text = format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" \
             viewBox=\"0 0 {w} {h}\" font-family=\"Helvetica, Arial, DejaVu Sans, sans-serif\">\n\
             <title>{}</title>\n<rect width=\"{w}\" height=\"{h}\" fill=\"#ffffff\"/>\n",
            escape(title)
        );
        Self { text, gradients: 0 }
    }

    /// The finished document.
    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }

    /// A line of connected points.
    pub(super) fn line(&mut self, points: &[Vec2], style: &str) {
        let path = path(points);
        self.text += &format!(
            "<path d=\"{path}\" fill=\"none\" stroke-linecap=\"round\" \
             stroke-linejoin=\"round\" {style}/>\n"
        );
    }

    /// A closed polygon.
    pub(super) fn polygon(&mut self, points: &[Vec2], style: &str) {
        let path = path(points);
        self.text += &format!("<path d=\"{path}Z\" stroke-linejoin=\"round\" {style}/>\n");
    }

    /// A circle.
    pub(super) fn circle(&mut self, center: Vec2, radius: f64, style: &str) {
        let [x, y] = center.map(number);
        self.text += &format!("<circle cx=\"{x}\" cy=\"{y}\" r=\"{}\" {style}/>\n", number(radius));
    }

    /// Text; `anchor` is `start`, `middle` or `end`.
    pub(super) fn label(&mut self, place: Vec2, anchor: &str, style: &str, text: &str) {
        let [x, y] = place.map(number);
        let text = escape(text);
        self.text +=
            &format!("<text x=\"{x}\" y=\"{y}\" text-anchor=\"{anchor}\" {style}>{text}</text>\n");
    }

    /// A gradient of three colours from one point to another; gives what `fill` refers to.
    pub(super) fn gradient(&mut self, from: Vec2, to: Vec2, colours: [&str; 3]) -> String {
        self.gradients += 1;
        let id = format!("g{}", self.gradients);
        let [[x1, y1], [x2, y2]] = [from, to].map(|point| point.map(number));
        let [first, second, third] = colours;
        self.text += &format!(
            "<linearGradient id=\"{id}\" gradientUnits=\"userSpaceOnUse\" x1=\"{x1}\" \
             y1=\"{y1}\" x2=\"{x2}\" y2=\"{y2}\"><stop offset=\"0\" stop-color=\"{first}\"/>\
             <stop offset=\"0.35\" stop-color=\"{second}\"/>\
             <stop offset=\"1\" stop-color=\"{third}\"/></linearGradient>\n"
        );
        format!("url(#{id})")
    }
}

fn path(points: &[Vec2]) -> String {
    let mut path = String::new();
    for (index, point) in points.iter().enumerate() {
        let [x, y] = point.map(number);
        path += &format!("{}{x} {y}", if index == 0 { 'M' } else { 'L' });
    }
    path
}

/// A coordinate with at most two decimals. What has no place in a picture is put at 0.
pub(super) fn number(value: f64) -> String {
    if !value.is_finite() {
        return "0".to_owned();
    }
    let text = format!("{:.2}", value.clamp(-1e6, 1e6));
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".to_owned() } else { text.to_owned() }
}

fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            // XML has no way to write most control characters
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_are_short_and_always_numbers() {
        let texts = [1.0, -0.001, 2.345, f64::NAN, 1e300, -12.5].map(number);
        assert_eq!(texts, ["1", "0", "2.35", "0", "1000000", "-12.5"]);
    }

    #[test]
    fn text_cannot_break_out_of_its_element() {
        assert_eq!(escape("a<b>&\u{1}c"), "a&lt;b&gt;&amp; c");
    }
}
