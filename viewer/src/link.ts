// `#t=2.4&view=side`: an instant and a view that can be sent as a link.

import { VIEWS, type ViewName } from "./camera";

export interface Link {
  time: number | undefined;
  view: ViewName | undefined;
}

export function readLink(): Link {
  const said = new URLSearchParams(location.hash.slice(1));
  const time = Number.parseFloat(said.get("t") ?? "");
  return {
    time: Number.isFinite(time) ? time : undefined,
    view: VIEWS.find((view) => view === said.get("view")),
  };
}

export function writeLink(time: number, view: ViewName): void {
  const hash = `#t=${Number(time.toFixed(2))}&view=${view}`;
  // Within the frame of a report there is no address to keep.
  if (location.protocol !== "about:" && hash !== location.hash) history.replaceState(null, "", hash);
}
