/* What ipywidgets does not say of its controls, said in JupyterLab: names for sliders and number boxes, values with
their unit ("0.15 m", not 0.15000000000000002), and the new numbers of a panel once a change has come to rest.

JupyterLab loads this file as it is (a "prebuilt extension" with nothing to build): at the end it registers itself under
its name, with the two functions that webpack's module federation asks for. */
"use strict";

(() => {
  const NAME = "course-lab";
  const STYLE = new URL("style.css", document.currentScript.src).href;
  const QUIET_MS = 600; // after the last change before it is said: not every step of a slider that moves
  const NARROW_PX = 1200; // a window in which the file list would take a third of the lesson's width

  /* The unit of a label: "m" for "alpha [m]"; none for "beta [-]". */
  function unitOf(label) {
    const unit = /\[([^\]]+)\]\s*$/.exec(label);
    return !unit || unit[1] === "-" ? "" : unit[1];
  }

  /* Without what a browser's arithmetic adds in the sixteenth digit. */
  const rounded = (text) => String(Number(Number(text).toFixed(9)) || 0);

  /* A number as people write it, with its unit: "-0.21 m" for "-0.21000000000000008". */
  function spoken(text, label) {
    if (text.trim() === "" || !Number.isFinite(Number(text))) return text;
    return `${rounded(text)} ${unitOf(label)}`.trim();
  }

  function set(element, attribute, value) {
    if (value && element.getAttribute(attribute) !== value) element.setAttribute(attribute, value);
  }

  const labelOf = (row) => row?.querySelector(".widget-label")?.textContent.trim() ?? "";

  /* Name and value of a slider's handle, from the label beside it. */
  function describeHandle(handle) {
    const slider = handle.closest(".widget-slider, .jupyter-widget-slider");
    const label = labelOf(slider);
    if (!label) return;
    const handles = [...slider.querySelectorAll(".noUi-handle")];
    const which = handles.length < 2 ? "" : handles.indexOf(handle) === 0 ? ", least" : ", greatest";
    set(handle, "aria-label", label + which);
    const value = handle.getAttribute("aria-valuetext") ?? "";
    if (Number.isFinite(Number(value))) {
      set(handle, "aria-valuenow", value.trim() && rounded(value)); // noUiSlider cuts it to one decimal
      set(handle, "aria-valuetext", spoken(value, label));
    }
  }

  /* Name of a number box without a label of its own: that of the slider before it. */
  function describeBox(box) {
    const widget = box.closest(".jupyter-widgets");
    if (!labelOf(widget)) set(box, "aria-label", labelOf(widget.previousElementSibling));
  }

  /* All elements of a kind in a new piece of the page, itself included. */
  function within(root, selector) {
    return [...(root.matches(selector) ? [root] : []), ...root.querySelectorAll(selector)];
  }

  const said = new WeakMap(); // a panel's numbers -> their text when they were last said
  const waiting = new Map(); // a panel's numbers -> timer

  function describe(root) {
    within(root, ".jupyter-widgets .noUi-handle").forEach(describeHandle);
    within(root, ".jupyter-widgets input.widget-input").forEach(describeBox);
    within(root, '.jupyter-widgets [title="null"]').forEach((element) => element.removeAttribute("title"));
  }

  /* Says a panel's numbers when they have been at rest for a while. What asks for attention at once (an error, with
  role="alert") is said by the browser itself. */
  function sayLater(numbers, region) {
    for (const status of numbers.querySelectorAll('[role="status"]')) set(status, "aria-live", "off"); // not twice
    clearTimeout(waiting.get(numbers));
    waiting.set(numbers, setTimeout(() => {
      waiting.delete(numbers);
      const text = numbers.textContent;
      if (!numbers.isConnected || text === said.get(numbers)) return;
      said.set(numbers, text);
      if (!numbers.querySelector('[role="alert"]')) region.textContent = text;
    }, QUIET_MS));
  }

  /* Says the verdict of a check, which is printed: "06.1: right." */
  function sayVerdict(output, region) {
    const verdict = /^(\d\d|P\d)\.\d+: .+$/m.exec(output.textContent);
    if (verdict && output.matches(".jp-OutputArea-child, .jp-OutputArea-output")) region.textContent = verdict[0];
  }

  /* The filter of the dark theme: the more colour a pixel has (its greatest channel less its least), the less of it is
  inverted. */
  const DARK = `<svg width="0" height="0" style="position: absolute" aria-hidden="true">
    <filter id="course-dark" x="0" y="0" width="100%" height="100%" color-interpolation-filters="sRGB">
      <feColorMatrix in="SourceGraphic" result="r" values="1 0 0 0 0  1 0 0 0 0  1 0 0 0 0  0 0 0 0 1" />
      <feColorMatrix in="SourceGraphic" result="g" values="0 1 0 0 0  0 1 0 0 0  0 1 0 0 0  0 0 0 0 1" />
      <feColorMatrix in="SourceGraphic" result="b" values="0 0 1 0 0  0 0 1 0 0  0 0 1 0 0  0 0 0 0 1" />
      <feBlend in="r" in2="g" mode="lighten" /><feBlend in2="b" mode="lighten" result="greatest" />
      <feBlend in="r" in2="g" mode="darken" /><feBlend in2="b" mode="darken" result="least" />
      <feBlend in="greatest" in2="least" mode="difference" />
      <feColorMatrix result="colour" values="0 0 0 0 0  0 0 0 0 0  0 0 0 0 0  6 0 0 0 -0.4" />
      <feComposite in="SourceGraphic" in2="colour" operator="in" result="coloured" />
      <feColorMatrix in="SourceGraphic" result="turned"
        values="-0.86 0 0 0 0.93  0 -0.86 0 0 0.93  0 0 -0.86 0 0.93  0 0 0 1 0" />
      <feComposite in="coloured" in2="turned" operator="over" />
    </filter></svg>`;

  function liveRegion() {
    const region = document.createElement("div");
    region.id = "course-says";
    region.setAttribute("role", "status");
    region.setAttribute("aria-live", "polite");
    document.body.append(region);
    return region;
  }

  function watch(region) {
    let ready = false; // what a page shows as it opens was not just found out
    document.addEventListener("keydown", () => { ready = true; }, { once: true, capture: true });
    document.addEventListener("pointerdown", () => { ready = true; }, { once: true, capture: true });
    const observer = new MutationObserver((records) => {
      for (const { type, target, addedNodes } of records) {
        if (type === "attributes") {
          if (target.matches(".noUi-handle")) describeHandle(target);
          else if (target.title === "null" && target.closest(".jupyter-widgets")) target.removeAttribute("title");
          continue;
        }
        for (const node of addedNodes) {
          if (!(node instanceof Element)) continue;
          describe(node);
          if (ready) sayVerdict(node, region);
        }
        const numbers = target.closest(".course-numbers");
        if (numbers) sayLater(numbers, region);
      }
    });
    describe(document.body);
    const filter = ["aria-valuetext", "title"];
    observer.observe(document.body, { subtree: true, childList: true, attributes: true, attributeFilter: filter });
  }

  /* JupyterLab's one-key commands act while a widget has the focus: the arrow keys would leave the slider's cell, and
  "d d" in a drop-down would delete it. Keys without Ctrl, Alt or Command belong to the control that has the focus. */
  function keepKeys() {
    window.addEventListener("keydown", (event) => {
      const control = event.target;
      if (!(control instanceof Element) || !control.closest(".jupyter-widgets")) return;
      const runs = event.key === "Enter" && event.shiftKey;
      const own = !(event.ctrlKey || event.metaKey || event.altKey || runs || event.key === "Escape");
      control.toggleAttribute("data-lm-suppress-shortcuts", own); // JupyterLab looks for it before its own keys
    }, true);
  }

  /* Whoever uses the keyboard alone can move what is wider than its place. */
  function reachScrolled() {
    for (const place of document.querySelectorAll(".jp-OutputArea-output, .course-panel > .widget-html")) {
      if (place.scrollWidth > place.clientWidth + 1) set(place, "tabindex", "0");
      else if (place.getAttribute("tabindex") === "0") place.removeAttribute("tabindex");
    }
  }

  /* In a narrow window a figure is as wide as its place: a click shows it in its own size, and another shrinks it. */
  function enlarge(event) {
    if (event.target.matches(".jp-OutputArea-output img")) event.target.classList.toggle("course-own-size");
  }

  function activate(app) {
    const style = document.createElement("link");
    style.rel = "stylesheet";
    style.href = STYLE;
    document.head.append(style);
    document.body.insertAdjacentHTML("beforeend", DARK);
    watch(liveRegion());
    keepKeys();
    const narrow = window.matchMedia(`(max-width: ${NARROW_PX}px)`);
    const makeRoom = () => narrow.matches && app.shell.collapseLeft?.();
    narrow.addEventListener("change", makeRoom);
    app.restored.then(makeRoom);
    window.addEventListener("resize", () => setTimeout(reachScrolled, QUIET_MS));
    document.addEventListener("load", reachScrolled, true); // of a picture
    document.addEventListener("click", enlarge);
  }

  const extension = { __esModule: true, default: { id: `${NAME}:panels`, autoStart: true, activate } };
  window._JUPYTERLAB = window._JUPYTERLAB ?? {};
  window._JUPYTERLAB[NAME] = { init: () => {}, get: async () => () => extension };
})();
