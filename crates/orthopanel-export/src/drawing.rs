//! A drawing of the panel with what is joined to it, for the page inside an FMU.

use std::fmt::Write as _;

use orthopanel_fmu::Resource;
use orthopanel_model::{Boundary, End, Piece, Place};

use crate::html::escaped;

/// The longer side on the page, in its units, and the room around for names.
const SIDE: f64 = 560.0;
const MARGIN: f64 = 70.0;

/// Inline SVG, to scale, x to the right and y up; z, along which forces and motions count, points at the reader.
pub(crate) fn draw(resource: &Resource, piece: &Piece, boundary: Boundary) -> String {
    let scale = SIDE / piece.length.max(piece.width);
    // A narrow beam still has room for the marks.
    let (long, high) = (scale * piece.length, (scale * piece.width).max(40.0));
    let across = high / piece.width;
    let at = |place: &Place| (MARGIN + 0.5 * long + scale * place.x, MARGIN + 0.5 * high - across * place.y);
    let (width, height) = (long + 2.0 * MARGIN, high + 2.0 * MARGIN);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" role=\"img\" \
         aria-label=\"The panel with its ports\" style=\"max-width: 100%; height: auto\" font-family=\"sans-serif\" font-size=\"12\">\n\
         <rect x=\"{MARGIN}\" y=\"{MARGIN}\" width=\"{long:.1}\" height=\"{high:.1}\" fill=\"#f4f1e8\" stroke=\"#888\"/>\n"
    );
    let (right, bottom) = (MARGIN + long, MARGIN + high);
    for (end, from, to) in [
        (boundary.left, (MARGIN, MARGIN), (MARGIN, bottom)),
        (boundary.right, (right, MARGIN), (right, bottom)),
        (boundary.front, (MARGIN, bottom), (right, bottom)),
        (boundary.back, (MARGIN, MARGIN), (right, MARGIN)),
    ] {
        let dashes = match end {
            End::Free => continue,
            End::Pinned => " stroke-dasharray=\"6 4\"",
            End::Clamped => "",
        };
        // Writing to a String has nothing to fail on, here and below.
        let _ = writeln!(
            svg,
            "<line x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" y2=\"{:.1}\" stroke=\"#222\" stroke-width=\"6\"{dashes}/>",
            from.0, from.1, to.0, to.1
        );
    }
    let (ports, names) = (resource.ports(), resource.names());
    let mounts = resource.connections().map(|connections| connections.mounts.as_slice()).unwrap_or_default();
    let mut labels: Vec<(Place, Vec<String>)> = Vec::new();
    let mut label = |place: &Place, text: String| match labels.iter_mut().find(|(other, _)| other == place) {
        Some((_, texts)) => texts.push(text),
        None => labels.push((*place, vec![text])),
    };
    for mount in mounts {
        let (x, y) = at(&mount.at);
        let _ = writeln!(
            svg,
            "<rect x=\"{:.1}\" y=\"{:.1}\" width=\"16\" height=\"16\" fill=\"none\" stroke=\"#2a7\" stroke-width=\"3\"/>",
            x - 8.0,
            y - 8.0
        );
        label(&mount.at, format!("mount {}", mount.name));
    }
    for (port, place) in ports.responses.iter().enumerate() {
        let (x, y) = at(place);
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" fill=\"none\" stroke=\"#15c\" stroke-width=\"2\"/>"
        );
        label(place, format!("response {}", names.response(port)));
    }
    for (port, place) in ports.forces.iter().enumerate() {
        let (x, y) = at(place);
        let _ = writeln!(svg, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"#c22\"/>");
        label(place, format!("force {}", names.force(port)));
    }
    for (place, texts) in &labels {
        let (x, y) = at(place);
        // Towards the middle, where there is room.
        let (anchor, dx) = if place.x > 0.0 { ("end", -10.0) } else { ("start", 10.0) };
        for (line, text) in texts.iter().enumerate() {
            let (x, y) = (x + dx, y - 6.0 + 13.0 * line as f64);
            let text = escaped(text);
            let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{text}</text>");
        }
    }
    let (length, width) = (piece.length, piece.width);
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{length} m along x</text>\n\
         <text x=\"20\" y=\"{:.1}\" text-anchor=\"middle\" transform=\"rotate(-90 20 {:.1})\">{width} m along y</text>\n</svg>",
        MARGIN + 0.5 * long,
        bottom + 45.0,
        MARGIN + 0.5 * high,
        MARGIN + 0.5 * high
    );
    svg + CAPTION
}

const CAPTION: &str = "<p>Red dots are forces, blue rings responses, green squares mounts; thick edges are clamped, dashed ones pinned. x points to the \
     right, y up, and z, along which forces and motions count, at the reader.</p>\n";
