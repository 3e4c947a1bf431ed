// What every page runs: tables that are sorted, tabs, and curves.
import { drawCharts } from "./charts.js";
import { makeScrollHint, makeSortable } from "./tables.js";
import { makeTabs } from "./tabs.js";
import { watch } from "./watch.js";

document.querySelectorAll("table.sortable").forEach(makeSortable);
document.querySelectorAll(".wide").forEach(makeScrollHint);
drawCharts(document);
document.querySelectorAll(".tabs").forEach(makeTabs);
if (document.documentElement.dataset.watches) watch();
document.documentElement.dataset.ready = "yes";
