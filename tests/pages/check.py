"""Opens pages in a headless Chromium and holds what pages promise.

    python tests/pages/check.py PAGE.html .. [--shots FOLDER] [--chromium PATH]

At 1280, 1920 and 400 px and on paper: no error, nothing is loaded, no horizontal overflow, every
column of every table can be reached, curves are drawn and answer the cursor, and robots are drawn,
move with their sliders and tell what is pointed at. axe-core has no serious finding. Prints how
large a page is, and after how long it answers: when no task of more than 50 ms is left.
"""

import argparse
import math
import os
import sys
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

AXE = Path(__file__).parents[2] / "crates/report/web/node_modules/axe-core/axe.min.js"
# faults of the kinds that keep people from reading a page
GRAVE = ("serious", "critical")

WIDTHS = (1280, 1920, 400)
MOST_BYTES = 4_000_000
MOST_LIBRARIES = 1_500_000
MOST_SECONDS = 1.5
# a dozen lines: more are words that are broken at letters [px]
TALLEST_ROW = 250

# the last column of each table that scrolls lies within its frame when it is scrolled there
COLUMNS = """() => [...document.querySelectorAll('.wide')].filter(box => box.querySelector('table')
  && box.clientWidth > 0).map(box => {
  box.scrollLeft = box.scrollWidth;
  const [frame, head] = [box.getBoundingClientRect(), box.querySelector('thead tr')];
  const last = head.lastElementChild.getBoundingClientRect();
  const first = head.firstElementChild.getBoundingClientRect();
  const fits = last.right <= frame.right + 1 && last.right > frame.left
    && Math.abs(first.left - frame.left) < 1.5 && frame.right <= innerWidth + 1;
  const wide = [...box.querySelectorAll('tbody tr')].map(row => row.clientHeight);
  box.scrollLeft = 0;
  return [fits, head.parentNode.parentNode.caption?.textContent ?? box.ariaLabel, Math.max(...wide)];
})"""

# a table that scrolls says so until its end is seen, and one that does not says nothing
HINTS = """async () => {
  const next = () => new Promise(done => requestAnimationFrame(() => setTimeout(done, 0)));
  const found = [];
  // what a tab has just shown is measured before the next picture
  await next();
  for (const box of document.querySelectorAll('.wide')) {
    if (!box.querySelector(':scope > table') || box.clientWidth === 0) continue;
    const hint = box.previousElementSibling;
    const scrolls = box.scrollWidth > box.clientWidth + 1;
    const told = hint?.classList.contains('hint') && !hint.hidden && /more column/.test(hint.textContent);
    const fades = getComputedStyle(box).maskImage !== 'none';
    box.scrollLeft = box.scrollWidth;
    await next();
    const ends = getComputedStyle(box).maskImage === 'none';
    box.scrollLeft = 0;
    await next();
    if (scrolls !== Boolean(told) || scrolls !== fades || !ends) found.push(box.ariaLabel);
  }
  return found;
}"""

# labels of a scene that are not whole within it, or lie over another
LABELS = """figure => {
  const frame = figure.querySelector('.stage').getBoundingClientRect();
  const boxes = [...figure.querySelectorAll('.labels span')].filter(one => one.checkVisibility())
    .map(one => [one.textContent, one.getBoundingClientRect()]);
  const cut = boxes.filter(([, at]) => at.left < frame.left || at.right > frame.right + 0.5
    || at.top < frame.top - 1 || at.bottom > frame.bottom + 1);
  const over = boxes.filter(([, a], at) => boxes.slice(at + 1).some(([, b]) =>
    a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 2 && b.top < a.bottom - 2));
  return [...cut, ...over].map(([name]) => name);
}"""

# how many pixels of a canvas are not transparent, and a sum that changes where these do
PIXELS = """canvas => {
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const context = copy.getContext('2d');
  context.drawImage(canvas, 0, 0);
  const { data } = context.getImageData(0, 0, copy.width, copy.height);
  let [seen, sum] = [0, 0];
  for (let at = 0; at < data.length; at += 4) if (data[at + 3] > 0) {
    seen += 1;
    sum = (sum * 31 + data[at] + 7 * data[at + 1] + 13 * data[at + 2] + at) % 1e9;
  }
  return [seen, sum, canvas.width * canvas.height];
}"""

# elements that words of a file could have made, and a mark that their scripts leave
FOREIGN = """() => document.querySelectorAll('img, iframe, object, embed, base, form').length
  + [...document.scripts].filter(script => script.type !== 'application/json').length
  - document.querySelectorAll('body > script').length + (window.hit === undefined ? 0 : 1)"""

# tasks that keep a page from answering
LONG_TASKS = """
window.longTasks = [];
new PerformanceObserver(list => list.getEntries().forEach(
  task => longTasks.push(task.startTime + task.duration))).observe({ entryTypes: ["longtask"] });
"""

# from when on a page answers: it is read, and no task of more than 50 ms is left [s]
READY = """() => {
  const { domInteractive, fetchStart } = performance.timing;
  return Math.max(domInteractive - fetchStart, ...window.longTasks) / 1000;
}"""

# what is not looked at is not drawn
MADE = "figure => figure.dataset.made === 'yes'"

SLIDE = """([slider, share]) => {
  slider.value = Number(slider.min) + share * (slider.max - slider.min);
  slider.dispatchEvent(new Event('input'));
}"""


class Checked:
    """One page, with the faults that were found."""

    def __init__(self, path):
        self.path = path
        self.faults = []
        self.drawn_s = math.inf

    def expect(self, holds, what):
        if not holds:
            self.faults.append(what)

    def listen(self, page):
        page.on("console", lambda note: self.expect(
            note.type not in ("error", "warning") or "GPU stall" in note.text, note.text))
        page.on("pageerror", lambda error: self.expect(False, str(error)))
        page.on("request", lambda request: self.expect(
            request.url.startswith(("file:", "data:")), f"asks for {request.url}"))

    def open(self, page, width):
        page.set_viewport_size({"width": width, "height": 900})
        started = time.monotonic()
        page.add_init_script(LONG_TASKS)
        page.goto(self.path.resolve().as_uri())
        page.wait_for_selector("html[data-ready=yes]", timeout=10_000)
        page.wait_for_selector("html[data-charts=yes]", timeout=20_000)
        if page.query_selector("figure.scene"):
            # here a processor draws what a graphics card would
            page.wait_for_selector("html[data-scene=yes]", timeout=20_000)
        self.drawn_s = min(self.drawn_s, time.monotonic() - started)
        # a task that began just before has ended
        page.wait_for_timeout(100)
        return page.evaluate(READY)

    def layout(self, page, width):
        # names and words of files stay text
        foreign = page.evaluate(FOREIGN)
        self.expect(foreign == 0, f"{foreign} elements that no page has, or a script of a name ran")
        overflow = page.evaluate("document.documentElement.scrollWidth - innerWidth")
        self.expect(overflow <= 0, f"{width} px: the page is {overflow} px too wide")
        tabs = page.query_selector_all("[role=tab]")
        for tab in [None, *tabs]:
            if tab:
                tab.click()
            for fits, name, tallest in page.evaluate(COLUMNS):
                self.expect(fits, f"{width} px: columns of `{name}` cannot be reached")
                told = f"{width} px: a row of `{name}` is {tallest} px high"
                self.expect(tallest <= TALLEST_ROW, told)
            # the page of a fleet has no script
            for name in page.evaluate(HINTS) if page.query_selector("body > script") else []:
                self.expect(False, f"{width} px: `{name}` does not say whether it scrolls")
        if tabs:
            tabs[0].click()
        for tag in ("h1", "main", "h2"):
            self.expect(page.query_selector(tag), f"no {tag}")
        bare = page.evaluate("""document.querySelectorAll(
            'canvas:not([aria-label], .uplot canvas), [style]:not(.uplot *, .uplot, .legend *, .ticks *, .labels *, .scene canvas)'
        ).length""")
        self.expect(bare == 0, f"{bare} elements without words, or with styles of their own")

    def curves(self, page, width):
        for chart in page.query_selector_all("figure.chart"):
            name = chart.query_selector(".name").inner_text()
            chart.scroll_into_view_if_needed()
            page.wait_for_function(MADE, arg=chart)
            canvas = chart.query_selector("canvas")
            seen, _, _ = canvas.evaluate(PIXELS)
            self.expect(seen > 500, f"{width} px: nothing is drawn of {name}")
            over = chart.query_selector(".u-over").bounding_box()
            page.mouse.move(over["x"] + 0.5 * over["width"], over["y"] + 0.5 * over["height"])
            page.wait_for_timeout(30)
            values = chart.eval_on_selector_all(
                ".u-value", "all => all.map(one => one.textContent).filter(text => /[0-9]/.test(text))")
            self.expect(values, f"{width} px: no value of {name} below the cursor")
            marks = chart.eval_on_selector_all(
                ".uplot", "all => all.map(one => Number(one.dataset.marks))")
            told = f"{width} px: a scale of {name} has {min(marks)} marks"
            self.expect(min(marks) > 1, told)

    def zoom(self, page):
        """Charts of a group show the same part."""
        ticks = ("() => [...document.querySelectorAll('figure.chart')].slice(0, 2)"
                 ".map(one => one.querySelector('.legend') && "
                 "one.querySelectorAll('canvas')[0].toDataURL().length)")
        plots = page.query_selector_all("figure.chart .plot")
        if len(plots) < 2:
            return
        before = page.evaluate(ticks)
        plots[0].focus()
        page.keyboard.press("+")
        page.wait_for_timeout(60)
        self.expect(before != page.evaluate(ticks), "a key does not zoom")
        page.keyboard.press("0")

    def scenes(self, page, width):
        for figure in page.query_selector_all("figure.scene"):
            if figure.is_visible():
                self.scene(page, figure, width)

    def scene(self, page, figure, width):
        figure.scroll_into_view_if_needed()
        page.wait_for_function(MADE, arg=figure)
        canvas = figure.query_selector("canvas")
        button = figure.query_selector(".play")
        slider = figure.query_selector(".line input" if button else ".joints input")
        sums = []
        for share in (0.1, 0.35, 0.8):
            page.evaluate(SLIDE, [slider, share])
            page.wait_for_timeout(50)
            seen, value, total = canvas.evaluate(PIXELS)
            self.expect(0.005 * total < seen < total, f"{width} px: the robot is not drawn")
            sums.append(value)
        self.expect(len(set(sums)) == 3, f"{width} px: the slider does not move the robot")
        for name in figure.evaluate(LABELS):
            self.expect(False, f"{width} px: the label {name} is cut, or lies over another")
        shapes = figure.query_selector(".marks input[value=shapes]")
        if shapes:
            shapes.click()
            page.wait_for_timeout(50)
            told = f"{width} px: shapes of links are not drawn in place of the rows"
            self.expect(canvas.evaluate(PIXELS)[1] != sums[2], told)
            shapes.click()
            page.wait_for_timeout(50)
            self.expect(canvas.evaluate(PIXELS)[1] == sums[2], told)
        if not button:
            self.pointed(page, figure, canvas, width)
            return
        button.click()
        page.wait_for_timeout(400)
        button.click()
        self.expect(canvas.evaluate(PIXELS)[1] != sums[2], f"{width} px: it does not play")

    def pointed(self, page, figure, canvas, width):
        """Somewhere on the canvas a link tells its row."""
        box = canvas.bounding_box()
        for step in range(1, 400):
            x, y = (step % 20) / 20, (step // 20) / 20
            page.mouse.move(box["x"] + x * box["width"], box["y"] + y * box["height"])
            if figure.query_selector(".now").inner_text():
                return
        self.expect(False, f"{width} px: no link tells its row when it is pointed at")

    def accessible(self, page, scheme):
        page.evaluate("document.querySelectorAll('details').forEach(one => { one.open = true; })")
        page.evaluate(AXE.read_text(encoding="utf-8"))
        found = page.evaluate("axe.run(document, {resultTypes: ['violations']})")
        for one in found["violations"]:
            if one["impact"] in GRAVE:
                where = [node["target"][0] for node in one["nodes"][:3]]
                self.expect(False, f"{scheme}: axe {one['id']}: {one['help']} at {where}")


def check(browser, path, shots):
    checked, took = Checked(path), None
    # pages of several folders have the same name
    name = "-".join(part for part in path.with_suffix("").parts if part not in ("/", ".", ".."))
    for scheme in ("light", "dark"):
        for width in WIDTHS:
            if scheme == "dark" and width != WIDTHS[0]:
                continue
            page = browser.new_page(color_scheme=scheme)
            checked.listen(page)
            seconds = checked.open(page, width)
            took = seconds if took is None else min(took, seconds)
            checked.layout(page, width)
            checked.curves(page, width)
            checked.scenes(page, width)
            checked.zoom(page)
            if width == WIDTHS[0]:
                checked.accessible(page, scheme)
            if shots:
                page.evaluate("scrollTo(0, 0)")
                page.screenshot(path=shots / f"{name}-{scheme}-{width}.png", full_page=True)
            if scheme == "light" and width == WIDTHS[0]:
                paper = page.pdf(format="A4", path=shots / f"{name}.pdf" if shots else None)
                checked.expect(len(paper) > 10_000, "the page on paper is empty")
            page.close()
    text = path.read_text(encoding="utf-8")
    checked.expect(len(text) <= MOST_BYTES, f"{len(text)} bytes, where {MOST_BYTES} are allowed")
    checked.expect(took <= MOST_SECONDS, f"ready after {took:.2f} s")
    checked.expect("unsafe-inline" not in text, "its policy allows what has no hash")
    print(f"{path}: {len(text)} bytes, ready after {took:.2f} s, "
          f"drawn after {checked.drawn_s:.2f} s")
    for fault in dict.fromkeys(checked.faults):
        print(f"  {fault}")
    return not checked.faults


def main():
    words = argparse.ArgumentParser()
    words.add_argument("pages", nargs="+", type=Path)
    words.add_argument("--shots", type=Path)
    words.add_argument("--chromium", default=os.environ.get("CHROMIUM", "/usr/bin/chromium"))
    given = words.parse_args()
    if given.shots:
        given.shots.mkdir(parents=True, exist_ok=True)
    flags = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
    with sync_playwright() as player:
        browser = player.chromium.launch(executable_path=given.chromium, args=flags)
        good = [check(browser, path, given.shots) for path in given.pages]
        browser.close()
    libraries = Path(__file__).parents[2] / "templates" / "html"
    size = sum((libraries / name).stat().st_size for name in ("page.js", "scene.js", "page.css"))
    print(f"libraries and styles: {size} bytes")
    return 0 if all(good) and size <= MOST_LIBRARIES else 1


if __name__ == "__main__":
    sys.exit(main())
