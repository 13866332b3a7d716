//! Draws `docs/chain.svg`: the closed chain with its angles, and the two postures between which a
//! crawl goes to and fro.
//!
//! `cargo run -p prone-report --example chain_drawing > docs/chain.svg`
//!
//! The postures are those of the shipped pull `nominal` on the NAO, by the chain of its mapping.

use std::error::Error;
use std::fmt::Write as _;

use prone::chain::{ChainAngles, ChainPosture, ClosedChain};
use prone::mapping::Mapping;
use prone_files::compiled_robot::CompiledRobot;
use prone_files::shipped;

const WIDTH: f64 = 820.0;
const HEIGHT: f64 = 590.0;

/// Names of the chain's points, from toe to elbow.
const POINTS: [&str; 6] = ["toe", "ankle", "knee", "hip", "shoulder", "elbow"];

/// Where each name stands beside its point, pixels right and down.
const NAME_AT: [[f64; 2]; 6] = [
    [-30.0, 20.0],
    [-48.0, -8.0],
    [-6.0, -16.0],
    [-10.0, 26.0],
    [-70.0, -16.0],
    [14.0, 20.0],
];

/// Radii of the arcs of θ1 to θ5, pixels.
const RADII: [f64; 5] = [46.0, 34.0, 74.0, 96.0, 46.0];

fn main() -> Result<(), Box<dyn Error>> {
    let robot = CompiledRobot::shipped(&shipped::NAO)?.into_robot();
    let gait = shipped::gait("nominal").ok_or("nominal does not ship")??;
    let mapping = Mapping::new(&robot, gait.mapping, gait.arm)?;
    let chain = *mapping.chain();
    let angles = |s: f64| chain.close(gait.parameters(s));

    let mut page = Page::new();
    let large = View::new(110.0, 250.0, 1.42);
    annotated(&mut page, &large, &chain, &angles(0.5)?);
    let [left, right] = [View::new(60.0, 500.0, 0.6), View::new(490.0, 500.0, 0.6)];
    let [extension, compression] = [chain.posture(&angles(0.0)?), chain.posture(&angles(1.0)?)];
    small(&mut page, &left, &extension, "extension");
    small(&mut page, &right, &compression, "compression");
    circuit(&mut page);
    print!("{}", page.finish());
    Ok(())
}

/// From metres in the sagittal plane to pixels.
struct View {
    x: f64,
    y: f64,
    pixels_per_metre: f64,
}

impl View {
    fn new(x: f64, y: f64, pixels_per_mm: f64) -> Self {
        Self {
            x,
            y,
            pixels_per_metre: pixels_per_mm * 1e3,
        }
    }

    fn points(&self, posture: &ChainPosture) -> [[f64; 2]; 6] {
        posture.points().map(|point| {
            [
                self.x + point.x() * self.pixels_per_metre,
                self.y - point.z() * self.pixels_per_metre,
            ]
        })
    }
}

/// The chain with the names of its points and angles, and its span.
fn annotated(page: &mut Page, view: &View, chain: &ClosedChain, angles: &ChainAngles) {
    page.title(
        24.0,
        "The closed chain, seen from the robot's right; forward is to the right",
    );
    let posture = chain.posture(angles);
    let points = view.points(&posture);
    page.floor(40.0, WIDTH - 40.0, view.y);
    let relative = [
        ("θ1", angles.toe),
        ("θ2", angles.ankle),
        ("θ3", angles.knee),
        ("θ4", angles.hip),
        ("θ5", angles.shoulder),
    ];
    let mut before = 0.0;
    for (((name, angle), at), radius) in relative.into_iter().zip(points).zip(RADII) {
        page.angle(at, before, angle, radius, name, "#0072b2");
        before += angle;
    }
    // α is absolute: it begins at the horizontal through the shoulder.
    page.angle(points[4], 0.0, before, 84.0, "α", "#d55e00");
    page.chain(&points, 6.0);
    for ((at, name), [right, down]) in points.into_iter().zip(POINTS).zip(NAME_AT) {
        page.text([at[0] + right, at[1] + down], "start", "#333", name);
    }
    page.dimension(points[0][0], points[5][0], view.y + 44.0, "span");
}

fn small(page: &mut Page, view: &View, posture: &ChainPosture, name: &str) {
    let points = view.points(posture);
    page.floor(view.x - 30.0, view.x + 295.0, view.y);
    page.chain(&points, 5.0);
    page.text([view.x + 130.0, view.y + 26.0], "middle", "#000", name);
}

/// Pull, recovery and cycle between the two small postures.
fn circuit(page: &mut Page) {
    page.title(350.0, "A cycle is a pull and a recovery");
    page.arrow([215.0, 408.0], [600.0, 408.0], -34.0);
    page.text(
        [410.0, 380.0],
        "middle",
        "#009e73",
        "pull: toes and elbows stay where they are, the trunk goes forward",
    );
    page.arrow([600.0, 534.0], [215.0, 534.0], -34.0);
    page.text(
        [410.0, 572.0],
        "middle",
        "#009e73",
        "recovery: the body lies on the floor, arms and legs go back",
    );
}

/// An SVG that is being written.
struct Page(String);

impl Page {
    fn new() -> Self {
        Self(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
             viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"DejaVu Sans, sans-serif\" \
             font-size=\"14\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        ))
    }

    fn add(&mut self, element: &str) {
        self.0.push_str(element);
        self.0.push('\n');
    }

    fn finish(mut self) -> String {
        self.add("</svg>");
        self.0
    }

    fn text(&mut self, [x, y]: [f64; 2], anchor: &str, colour: &str, text: &str) {
        self.add(&format!(
            "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" fill=\"{colour}\">{text}</text>"
        ));
    }

    fn title(&mut self, y: f64, text: &str) {
        self.add(&format!(
            "<text x=\"{}\" y=\"{y}\" text-anchor=\"middle\" font-weight=\"bold\">{text}</text>",
            WIDTH / 2.0
        ));
    }

    fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], style: &str) {
        self.add(&format!(
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" {style}/>"
        ));
    }

    fn floor(&mut self, from: f64, to: f64, y: f64) {
        self.line([from, y], [to, y], "stroke=\"#888\" stroke-width=\"1.5\"");
    }

    fn chain(&mut self, points: &[[f64; 2]; 6], width: f64) {
        let mut path = String::new();
        for (index, [x, y]) in points.iter().enumerate() {
            let letter = if index == 0 { 'M' } else { 'L' };
            // Writing to a string does not fail.
            let _ = write!(path, "{letter}{x:.1} {y:.1}");
        }
        self.add(&format!(
            "<path d=\"{path}\" fill=\"none\" stroke=\"#222\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\" stroke-linecap=\"round\"/>"
        ));
        for [x, y] in points {
            self.add(&format!(
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{width}\" fill=\"#fff\" stroke=\"#222\" \
                 stroke-width=\"2\"/>"
            ));
        }
    }

    /// An angle from the direction `before` on, radians, counter-clockwise positive: its two legs
    /// that are no link are dashed.
    fn angle(
        &mut self,
        at: [f64; 2],
        before: f64,
        turn: f64,
        radius: f64,
        name: &str,
        colour: &str,
    ) {
        let on =
            |angle: f64, radius: f64| [at[0] + radius * angle.cos(), at[1] - radius * angle.sin()];
        let dashed = format!("stroke=\"{colour}\" stroke-dasharray=\"4 4\"");
        self.line(at, on(before, radius + 14.0), &dashed);
        let ([x1, y1], [x2, y2]) = (on(before, radius), on(before + turn, radius));
        // Screens have y down: counter-clockwise is sweep 0.
        let sweep = i32::from(turn < 0.0);
        self.add(&format!(
            "<path d=\"M{x1:.1} {y1:.1}A{radius} {radius} 0 0 {sweep} {x2:.1} {y2:.1}\" \
             fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>"
        ));
        self.tip([x2, y2], before + turn + 1.571_f64.copysign(turn), colour);
        let [x, y] = on(before + turn / 2.0, radius + 15.0);
        self.text([x, y + 5.0], "middle", colour, name);
    }

    /// The head of an arrow at `at` that goes in a direction, radians.
    fn tip(&mut self, at: [f64; 2], direction: f64, colour: &str) {
        let corner = |turn: f64| {
            let angle = direction + turn;
            format!(
                "{:.1} {:.1}",
                at[0] - 10.0 * angle.cos(),
                at[1] + 10.0 * angle.sin()
            )
        };
        self.add(&format!(
            "<path d=\"M{:.1} {:.1}L{}L{}Z\" fill=\"{colour}\"/>",
            at[0],
            at[1],
            corner(0.35),
            corner(-0.35)
        ));
    }

    fn dimension(&mut self, from: f64, to: f64, y: f64, name: &str) {
        let colour = "#cc79a7";
        let style = format!("stroke=\"{colour}\" stroke-width=\"2\"");
        for x in [from, to] {
            self.line([x, y - 34.0], [x, y + 8.0], &format!("stroke=\"{colour}\""));
        }
        self.line([from, y], [to, y], &style);
        self.tip([from, y], std::f64::consts::PI, colour);
        self.tip([to, y], 0.0, colour);
        self.text([f64::midpoint(from, to), y + 18.0], "middle", colour, name);
    }

    /// A bent arrow; `rise` is how far it bends to its left, pixels.
    fn arrow(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], rise: f64) {
        let colour = "#009e73";
        let bend = if x2 > x1 { rise } else { -rise };
        let (x, y) = (f64::midpoint(x1, x2), f64::midpoint(y1, y2) + bend);
        self.add(&format!(
            "<path d=\"M{x1} {y1}Q{x} {y} {x2} {y2}\" fill=\"none\" stroke=\"{colour}\" \
             stroke-width=\"3\"/>"
        ));
        self.tip([x2, y2], (y - y2).atan2(x2 - x), colour);
    }
}
