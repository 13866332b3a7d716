//! The page of somebody's own runs: the replay first, then what each run holds, and the results of a
//! publication's own commands behind them. A figure that no run has is not mentioned.

use maud::{Markup, html};

use super::{Page, REPLAY};
use crate::figures::each_once;
use crate::report::publication::{Part, Place};
use crate::report::run::Content;
use crate::report::shown::Shown;
use crate::report::{Run, card_sections, curve_tables, places, run_sections};

/// How many runs the heading of a page names.
const NAMED: usize = 3;

/// Where the links of the contents lead.
const CARD: &str = "section-card";
const PUBLISHED: &str = "section-published";
const CONDITIONS: &str = "section-conditions";

/// A link of the contents: where it leads, what it is called, and of which folder it is.
struct Link<'a> {
    to: String,
    called: String,
    folder: Option<&'a str>,
}

impl<'a> Link<'a> {
    fn new(to: &str, called: &str) -> Self {
        Self {
            to: to.to_owned(),
            called: called.to_owned(),
            folder: None,
        }
    }

    fn of_run(number: usize, run: &'a Run) -> Self {
        Self {
            to: run_id(number),
            called: run.title(),
            folder: Some(&run.folder.name),
        }
    }
}

impl Page<'_> {
    /// What the page holds, in a few words.
    pub(super) fn holds(&self) -> String {
        let titles: Vec<String> = self.named().map(Run::title).collect();
        let titles = each_once(titles.iter().map(String::as_str), &[]);
        match titles.len() {
            0 => "Report without runs".to_owned(),
            count if count <= NAMED => titles.join(", "),
            count => format!(
                "{} and {} more",
                titles[..NAMED - 1].join(", "),
                count - NAMED + 1
            ),
        }
    }

    pub(super) fn by_run_header(&self) -> Markup {
        let not_simulated = self.not_simulated();
        let published = self.publication.name();
        let published = published.filter(|_| self.published().next().is_some());
        html! {
            header {
                h1 { (self.holds()) }
                p.lead {
                    "Made from the records of " (self.titles().join("; ")) ". "
                    strong { "Ours" } " is what this program simulated. "
                    @if let Some(name) = published { strong { "Published" } " is " (name) ". " }
                    @if !self.cards.is_empty() { strong { "Theirs" } " is somebody else's. " }
                    @if not_simulated.is_empty() { "No robot took part." }
                    @else { "Not simulated: " (not_simulated.join(", ")) "." }
                }
            }
        }
    }

    /// What is before the replay.
    pub(super) fn by_run_above(&self) -> Markup {
        html! {
            (self.shortfalls())
            nav aria-label="Contents" {
                ul.contents { @for link in self.links() { li {
                    a href={ "#" (link.to) } { (link.called) }
                    @if let Some(folder) = link.folder { " " small.run { (folder) } }
                } } }
            }
        }
    }

    /// What is after it.
    pub(super) fn by_run_below(&self) -> Markup {
        let study = self.published().next().is_some();
        html! {
            @if !self.cards.is_empty() {
                div id=(CARD) {
                    (card_sections::all(self.cards, self.publication.crawled().filter(|_| study)))
                }
            }
            @for (number, run) in self.own() { (self.run(number, run)) }
            @if study { (self.study()) }
            (self.unrecorded())
            div id=(CONDITIONS) { (run_sections::what_was_run(self.runs)) }
        }
    }

    fn links(&self) -> Vec<Link<'_>> {
        let mut links = Vec::new();
        if self.runs.iter().any(|run| run.record().is_some()) {
            links.push(Link::new(REPLAY, "Replay"));
        }
        if !self.cards.is_empty() {
            links.push(Link::new(CARD, "Report card"));
        }
        links.extend(self.own().map(|(number, run)| Link::of_run(number, run)));
        if let Some(run) = self.published().next() {
            links.push(Link::new(PUBLISHED, run.title()));
            let parts = self.filled_parts();
            links.extend(parts.map(|(number, part)| Link::new(&part_id(number), &part.title)));
        }
        links.push(Link::new(CONDITIONS, "What was run"));
        links
    }

    /// The runs that have something to show by themselves, with their places among all.
    fn own(&self) -> impl Iterator<Item = (usize, &Run)> {
        let runs = self.runs.iter().enumerate();
        runs.filter(|(_, run)| {
            let found = matches!(run.content, Content::Pulls(_) | Content::Cycles(_));
            run.is_own() && (found || self.figures_of(run).next().is_some())
        })
    }

    /// The figures that come from a run before all others.
    fn figures_of(&self, run: &Run) -> impl Iterator<Item = &Shown> {
        let name = run.folder.name.clone();
        let shown = self.shown.iter();
        shown.filter(move |shown| shown.runs.first() == Some(&name))
    }

    /// What one run holds.
    fn run(&self, number: usize, run: &Run) -> Markup {
        html! {
            section id=(run_id(number)) {
                h2 { (run.title()) }
                p.run { (run.folder.name) " (" (run.folder.head.command) ")" }
                // Pictures first: they tell at a glance what the run is about.
                @for figure in self.figures_of(run) { (self.unnumbered(figure)) }
                @if let Some(found) = run_sections::found(run) { (found) }
                @if let Content::Pulls(search) = &run.content {
                    (curve_tables::found(&search.result.gait, &run.folder.name, &search.result.curves))
                }
            }
        }
    }

    /// A figure of somebody's own: it has no number, and nothing is published of it.
    fn unnumbered(&self, figure: &Shown) -> Markup {
        let caption = html! {
            strong { (figure.title) ". " }
            (figure.caption)
            @if figure.runs.len() > 1 { " " span.run { "The same in " (figure.runs.join(", ")) "." } }
        };
        self.figure(figure, &caption)
    }

    /// Results of a publication's own commands, with the numbers of their figures.
    fn study(&self) -> Markup {
        let others = self
            .study_figures()
            .filter(|shown| places(self.publication).all(|place| place.number != shown.number));
        html! {
            section id=(PUBLISHED) {
                @for run in self.published().take(1) { h2 { (run.title()) } }
                @if let Some(lead) = self.publication.lead() { p { (lead) } }
            }
            @for run in self.published() { (run.results()) }
            @for (number, part) in self.filled_parts() {
                section id=(part_id(number)) {
                    h2 { (part.title) }
                    p { (part.lead) }
                    @for place in &part.places {
                        @for (index, figure) in self.figures_at(place).enumerate() {
                            (self.captioned(figure, place.published.as_deref().filter(|_| index == 0)))
                        }
                        @for run in self.published() { (run.tables_after(&place.number)) }
                    }
                }
            }
            @for run in self.published() { (run.sections()) }
            @for figure in others { (self.captioned(figure, None)) }
        }
    }

    /// The sections of the publication of which there are figures, with their places among all.
    fn filled_parts(&self) -> impl Iterator<Item = (usize, &Part)> {
        let parts = self.publication.parts().iter().enumerate();
        parts.filter(|(_, part)| {
            let mut places = part.places.iter();
            places.any(|place| self.figures_at(place).next().is_some())
        })
    }

    /// The figures of a publication's own results.
    fn study_figures(&self) -> impl Iterator<Item = &Shown> {
        self.shown.iter().filter(|shown| {
            let mut own = self.runs.iter().filter(|run| run.is_own());
            own.all(|run| shown.runs.first() != Some(&run.folder.name))
        })
    }

    fn figures_at(&self, place: &Place) -> impl Iterator<Item = &Shown> {
        let figures = self.study_figures();
        figures.filter(|shown| shown.number == place.number)
    }
}

fn run_id(number: usize) -> String {
    format!("section-run-{}", number + 1)
}

fn part_id(number: usize) -> String {
    format!("section-part-{}", number + 1)
}
