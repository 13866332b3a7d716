//! The page of a publication's chapter: its numbered figures in their order, and what stands where a
//! figure is not there.

use maud::{Markup, html};

use super::Page;
use crate::report::publication::{Part, Place};
use crate::report::run::Content;
use crate::report::shown::Shown;
use crate::report::{card_sections, curve_tables, figure_html, places, run_sections};

/// Number of the figure that shows what gaits are made of; their tables follow it.
const CURVES: &str = "25";

impl Page<'_> {
    /// What is before the replay.
    pub(super) fn chapter_above(&self) -> Markup {
        html! {
            (self.shortfalls())
            (self.unrecorded())
            @for run in self.published() { (run.results()) }
            (card_sections::all(self.cards, self.publication.crawled()))
        }
    }

    /// What is after it.
    pub(super) fn chapter_below(&self) -> Markup {
        html! {
            @for part in self.publication.parts() { (self.part(part)) }
            @for run in self.published() { (run.sections()) }
            (run_sections::searches(self.runs))
            (self.beyond())
            (run_sections::what_was_run(self.runs))
        }
    }

    pub(super) fn chapter_header(&self) -> Markup {
        let not_simulated = self.not_simulated();
        html! {
            header {
                h1 { (self.publication.title()) }
                p.lead {
                    "Made from the records of " (self.titles().join("; ")) ". " (self.publication.lead().unwrap_or_default()) " "
                    strong { "Ours" } " is what this program simulated; "
                    @if let Some(name) = self.publication.name() { strong { "published" } " is " (name) "; " }
                    strong { "theirs" } " is somebody else's. "
                    @if not_simulated.is_empty() { "No robot took part." }
                    @else { "Not simulated: " (not_simulated.join(", ")) "." }
                }
            }
        }
    }

    fn part(&self, part: &Part) -> Markup {
        html! {
            section {
                h2 { (part.title) }
                p { (part.lead) }
                @for place in &part.places {
                    (self.place(place))
                    (self.tables_after(&place.number))
                }
            }
        }
    }

    /// The figures of one number, or what would fill their place.
    fn place(&self, place: &Place) -> Markup {
        let figures: Vec<&Shown> = self
            .shown
            .iter()
            .filter(|shown| shown.number == place.number)
            .collect();
        html! {
            @if figures.is_empty() { (figure_html::empty(place)) }
            // What is published stands below the first of several.
            @for (index, figure) in figures.iter().enumerate() {
                (self.captioned(figure, place.published.as_deref().filter(|_| index == 0)))
            }
        }
    }

    /// Tables of the chapter that follow a figure.
    fn tables_after(&self, number: &str) -> Markup {
        html! {
            @for run in self.published() { (run.tables_after(number)) }
            @if number == CURVES { (self.curves()) }
        }
    }

    /// A figure with its number, and what is published of it.
    pub(super) fn captioned(&self, figure: &Shown, published: Option<&str>) -> Markup {
        let caption = html! {
            strong {
                @if !figure.number.is_empty() { "Figure " (figure.number) ". " }
                (figure.title) ". "
            }
            (figure.caption)
            @if let Some(published) = published { " " (published) }
            @if self.runs.len() > 1 { " " span.run { "From " (figure.runs.join(", ")) "." } }
        };
        self.figure(figure, &caption)
    }

    /// Figures that have no place in the publication.
    fn beyond(&self) -> Markup {
        let has_place = |number: &str| places(self.publication).any(|place| place.number == number);
        let others = self.shown.iter();
        let others: Vec<&Shown> = others.filter(|shown| !has_place(&shown.number)).collect();
        html! {
            @if !others.is_empty() {
                section {
                    @if self.publication.parts().is_empty() { h2 { "Figures" } }
                    @else { h2 { "Beyond the chapter" } }
                    @for figure in others { (self.captioned(figure, None)) }
                    @if !has_place(CURVES) { (self.curves()) }
                }
            }
        }
    }

    /// What gaits that were found are made of.
    fn curves(&self) -> Markup {
        html! {
            @for run in self.runs {
                @if let Content::Pulls(search) = &run.content {
                    (curve_tables::found(&search.result.gait, &run.folder.name, &search.result.curves))
                }
            }
        }
    }
}
