/** States that stand in a row, drawn against their number while the run goes on. */

/** @import {PlantBench} from "../../core/plant/bench.js" */
/** @import {PlantRun} from "../../core/plant/run.js" */
/** @import {Ranges} from "../../core/types.js" */

import { formatNumber } from "../../core/format.js";
import { profilesOf } from "../../core/plant/profile.js";
import { choice } from "../../components/form-parts.js";
import { createPanelFrame } from "../../components/panel-frame.js";
import { readTheme } from "../../components/theme.js";
import { createFigure } from "../../plots/figure.js";
import { profilePlot } from "../../plots/plant/profile.js";

const EVERY = 100;

/**
 * @param {HTMLElement} host
 * @param {PlantBench} bench
 * @param {PlantRun} run
 * @returns {{frame: (now: number) => void, refresh: () => void} | null}  null where no states stand in a row
 */
export function mount(host, bench, run) {
  const profiles = profilesOf(bench.model.states);
  const [first] = profiles;
  if (!first) return null;
  let profile = first;
  /** @type {Ranges} */
  let ranges = {};
  let drawn = 0;
  const which = choice("Show", profiles.map(({ stem, members }) => ({ value: stem, label: `${stem}, ${members.length} in a row` })), () => {
    profile = profiles.find(({ stem }) => stem === which.value) ?? first;
    ranges = {};
    draw(false);
  });
  const frame = createPanelFrame(host, {
    id: "plant-profile",
    title: "Profile",
    help: "States in a row against their number, as they are at the moment of the run; dashed as they were at its start.",
    figure: createFigure,
    controls: [which.root],
    table: () => ({ header: ["number", profile.stem], rows: profile.members.map(({ index, name }) => [index, run.values()[name] ?? null]) }),
  });
  frame.root.classList.add("answered");

  /** @param {boolean} moving */
  function draw(moving) {
    const { columns, t } = run.history;
    if (t.length === 0) return;
    const now = run.values();
    const figure = profilePlot({ index: profile.members.map(({ index }) => index), now: profile.members.map(({ name }) => now[name] ?? NaN), first: profile.members.map(({ name }) => columns[`states.${name}`]?.[0] ?? NaN), stem: profile.stem, unit: profile.unit }, readTheme(), { ranges, moving });
    ranges = figure.ranges;
    frame.show(figure, moving);
    if (!moving) frame.tell(`${profile.stem} from ${formatNumber(now[profile.members[0]?.name ?? ""])} to ${formatNumber(now[profile.members.at(-1)?.name ?? ""])}.`, [{ signal: "y", label: "now", name: "at the moment of the run" }, { signal: "r", label: "at the start", name: "at the start of the run", dash: "dash" }]);
  }
  return {
    frame(now) {
      if (now - drawn < EVERY) return;
      drawn = now;
      draw(true);
    },
    refresh: () => draw(false),
  };
}
