//! What may be typed after `prone export`.

use std::path::PathBuf;

use clap::ValueEnum;

use prone_record::recorded::Part;

/// Smallest and largest edge of a picture, pixels.
const EDGE: std::ops::RangeInclusive<usize> = 16..=4096;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  prone crawl run low-175 --record out/low
  prone export out/low --format mcap               for Foxglove, Rerun, PlotJuggler
  prone export out/low --format bag --out low_bag  a folder for `ros2 bag play low_bag`
  prone export out/low --format npz --out low.npz
  prone export out/low --format mp4 --view follow  needs ffmpeg
  prone export out/low --format gif --view side --size 480x270 --fps 10

RUN is a folder that `prone crawl run --record` has written, or one of pulls/ and crawls/ in the
result of `prone reproduce`. csv, mcap, bag, npz and the pictures show what was simulated; urdf is the
robot; xar and keyframes are one cycle as the gait commands it, without turning, and say how far the
simulated joints were behind it. They are refused where straight lines between the key frames make a
joint faster than its manufacturer allows, xar also for a robot that Choregraphe does not know. Of a
record that was cut off, csv and the pictures show the instants that are left, mcap, bag and npz also
the contacts that are left; the exit code is then 2. urdf, xar and keyframes need neither. A bag
replaces nothing but an earlier bag of prone.")]
pub(crate) struct ExportArgs {
    /// Folder of a recorded run
    #[arg(value_name = "RUN")]
    pub(crate) run: PathBuf,
    /// Format of the file
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub(crate) format: Format,
    /// Where to write; of a bag, the folder [default: the run's name with the format's ending, in the
    /// working directory]
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Robot folder, if the run's is not where it was [default: that of the run]
    #[arg(long, value_name = "DIR")]
    pub(crate) robot: Option<PathBuf>,
    /// mp4, webp, gif: where the camera is [default: follow]
    #[arg(long, value_enum, value_name = "VIEW")]
    pub(crate) view: Option<ViewName>,
    /// mp4, webp, gif: width and height, pixels [default: 960x540]
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(crate) size: Option<(usize, usize)>,
    /// mp4, webp, gif: pictures per second, 1 to 60 [default: 25]
    #[arg(long, value_name = "N", value_parser = rate, allow_negative_numbers = true)]
    pub(crate) fps: Option<f64>,
    /// mp4, webp, gif: first instant, s [default: the run's]
    #[arg(long, value_name = "S", value_parser = instant, allow_negative_numbers = true)]
    pub(crate) from_s: Option<f64>,
    /// mp4, webp, gif: last instant, s [default: the run's]
    #[arg(long, value_name = "S", value_parser = instant, allow_negative_numbers = true)]
    pub(crate) to_s: Option<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum Format {
    /// One tidy table: time, joint, command, position, velocity, effort
    Csv,
    /// ROS 2 messages: joint states, tf, contacts, robot description
    Mcap,
    /// The same as a folder with metadata.yaml, as `ros2 bag` writes it
    Bag,
    /// Arrays of numpy
    Npz,
    /// The robot
    Urdf,
    /// One commanded cycle as a Choregraphe timeline
    Xar,
    /// One commanded cycle as JSON key frames
    Keyframes,
    /// Video, by ffmpeg
    Mp4,
    /// Animation without loss
    Webp,
    /// Animation of 256 colours
    Gif,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(crate) enum ViewName {
    /// From the right, the whole way; the camera stays
    Side,
    /// From the camera in the robot's head
    Eye,
    /// From ahead and the right; the camera goes along
    Follow,
}

impl Format {
    /// Of which tables of a record it is made; the others need none.
    pub(crate) const fn parts(self) -> &'static [Part] {
        match self {
            Self::Csv | Self::Mp4 | Self::Webp | Self::Gif => &[Part::Rows],
            Self::Npz | Self::Mcap | Self::Bag => &[Part::Rows, Part::Contacts],
            Self::Urdf | Self::Xar | Self::Keyframes => &[],
        }
    }

    /// What follows the run's name where the file or folder has no other.
    pub(crate) const fn ending(self) -> &'static str {
        match self {
            Self::Csv => ".csv",
            Self::Mcap => ".mcap",
            // A name in `.bag` is a file of ROS 1 to those who read bags.
            Self::Bag => "_bag",
            Self::Npz => ".npz",
            Self::Urdf => ".urdf",
            Self::Xar => ".xar",
            Self::Keyframes => ".keyframes.json",
            Self::Mp4 => ".mp4",
            Self::Webp => ".webp",
            Self::Gif => ".gif",
        }
    }

    /// Its name, as it is typed.
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::Csv => "csv",
            Self::Mcap => "mcap",
            Self::Bag => "bag",
            Self::Npz => "npz",
            Self::Urdf => "urdf",
            Self::Xar => "xar",
            Self::Keyframes => "keyframes",
            Self::Mp4 => "mp4",
            Self::Webp => "webp",
            Self::Gif => "gif",
        }
    }
}

fn size(text: &str) -> Result<(usize, usize), String> {
    let edges = text.split_once(['x', '×']);
    let edge = |text: &str| text.parse().ok().filter(|edge| EDGE.contains(edge));
    edges
        .and_then(|(width, height)| edge(width).zip(edge(height)))
        .ok_or_else(|| {
            format!(
                "not WIDTHxHEIGHT with edges of {} to {} pixels",
                EDGE.start(),
                EDGE.end()
            )
        })
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (1.0..=60.0).contains(rate));
    rate.ok_or_else(|| "not a number of 1 to 60 pictures per second".to_owned())
}

fn instant(text: &str) -> Result<f64, String> {
    let instant = text
        .parse()
        .ok()
        .filter(|seconds| (0.0..1e6).contains(seconds));
    instant.ok_or_else(|| "not a time since the first pull began, s".to_owned())
}
