// Tabs: without scripts, and on paper, all panels are seen one below the other.

function select(tabs, panels, chosen) {
  tabs.forEach((tab, place) => {
    tab.setAttribute("aria-selected", String(place === chosen));
    tab.tabIndex = place === chosen ? 0 : -1;
    panels[place].classList.toggle("away", place !== chosen);
  });
}

export function makeTabs(box) {
  const tabs = [...box.querySelectorAll(":scope > [role=tablist] > [role=tab]")];
  const panels = [...box.querySelectorAll(":scope > [role=tabpanel]")];
  tabs.forEach((tab, place) => {
    tab.addEventListener("click", () => select(tabs, panels, place));
    tab.addEventListener("keydown", event => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const next = (place + step + tabs.length) % tabs.length;
      select(tabs, panels, next);
      tabs[next].focus();
    });
  });
  select(tabs, panels, 0);
}
