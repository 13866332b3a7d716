//! Pictures that move.

use std::path::Path;

use anyhow::anyhow;

use prone_record::recorded::Recorded;
use prone_record::single_file;
use prone_study::export::film::{Film, Interrupted, Shot, View};
use prone_study::export::gif_film::{self, GifReel};
use prone_study::export::webp_film::WebpReel;

use super::ffmpeg::Ffmpeg;
use super::origin;
use crate::args::{ExportArgs, Format, ViewName};
use crate::progress::Progress;
use crate::{Failure, interrupt};

/// Unless said otherwise.
const SIZE: (usize, usize) = (960, 540);
const FPS: f64 = 25.0;

/// Films, writes, and says what.
pub(super) fn run(args: &ExportArgs, record: &Recorded, out: &Path) -> Result<String, Failure> {
    let shot = shot(args, record)?;
    single_file::check_place(out).map_err(Failure::input)?;
    let robot = origin::robot(args, &record.run)?;
    let world = origin::world(&robot, record)?;
    let film = Film::new(&world, record, shot).map_err(Failure::input)?;
    match args.format {
        Format::Gif => {
            let mut reel = GifReel::new(shot.size, shot.fps).map_err(Failure::work)?;
            shoot(&film, &mut reel)?;
            let bytes = reel.finish().map_err(Failure::work)?;
            put(out, &bytes)?;
        }
        Format::Webp => {
            let mut reel = WebpReel::new(shot.size, shot.fps);
            shoot(&film, &mut reel)?;
            put(out, &reel.finish())?;
        }
        _ => {
            let mut reel = Ffmpeg::start(out, &shot)?;
            shoot(&film, &mut reel)?;
            let file = reel.finish()?;
            interrupt::publish(|| Ok(file.put()?))?;
        }
    }
    let (width, height) = shot.size;
    let (pictures, fps) = (film.len(), shot.fps);
    let seconds = pictures as f64 / fps;
    Ok(format!(
        "{pictures} pictures of {width} × {height}, {seconds:.2} s at {fps} per second"
    ))
}

fn shoot<R>(film: &Film<'_>, reel: &mut R) -> Result<(), Failure>
where
    R: prone_study::export::film::Reel,
    R::Error: Into<anyhow::Error>,
{
    let progress = Progress::filming(film.len())?;
    let done = film.shoot(reel, &progress);
    progress.finish();
    done.map_err(|interrupted| match interrupted {
        Interrupted::Stopped => Failure::Stopped,
        Interrupted::Failed(error) => Failure::work(error),
    })
}

fn put(out: &Path, bytes: &[u8]) -> Result<(), Failure> {
    interrupt::publish(|| Ok(single_file::write(out, bytes)?))
}

fn shot(args: &ExportArgs, record: &Recorded) -> Result<Shot, Failure> {
    let (begin, end) = record.span_s();
    let (from, to) = (args.from_s.unwrap_or(begin), args.to_s.unwrap_or(end));
    // Half a row more than the record has is not worth a complaint.
    if from > to || from > end || to < begin || to > end + 0.01 {
        return Err(Failure::Input(anyhow!(
            "there is nothing from {from} s to {to} s: the record has {begin:.2} s to {end:.2} s"
        )));
    }
    let size = args.size.unwrap_or(SIZE);
    let fps = args.fps.unwrap_or(FPS);
    if args.format == Format::Mp4 && (size.0 % 2 == 1 || size.1 % 2 == 1) {
        return Err(Failure::Input(anyhow!(
            "mp4 needs even numbers of pixels, not {}x{}",
            size.0,
            size.1
        )));
    }
    if args.format == Format::Gif && fps > gif_film::FASTEST {
        return Err(Failure::Input(anyhow!(
            "gif shows at most {} pictures per second",
            gif_film::FASTEST
        )));
    }
    Ok(Shot {
        view: match args.view.unwrap_or(ViewName::Follow) {
            ViewName::Side => View::Side,
            ViewName::Eye => View::Eye,
            ViewName::Follow => View::Follow,
        },
        size,
        fps,
        span_s: (from.max(begin), to.min(end)),
    })
}
