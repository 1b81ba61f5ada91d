// SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
// SPDX-License-Identifier: Apache-2.0
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const root = document.documentElement;
  const wanted = window.matchMedia("(prefers-color-scheme: dark)");
  const button = document.getElementById("theme");
  const places = [...document.querySelectorAll("[data-figure]")];
  const chosen = {};
  let dark = wanted.matches;

  // The figures name their colours as on white; here each is exchanged for its like on black, and
  // scales are turned round, so that much is what stands out from the page.
  const themed = (figure, isDark) => {
    let text = JSON.stringify(figure);
    if (isDark) {
      for (const [light, other] of Object.entries(data.dark)) {
        text = text.split(light).join(other);
      }
    }
    const copy = JSON.parse(text);
    for (const [name, axis] of Object.entries(copy.layout)) {
      if (name.startsWith("coloraxis") && isDark && !axis.meta) axis.reversescale = true;
    }
    return copy;
  };

  const settings = {
    responsive: true,
    displaylogo: false,
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toggleSpikelines"],
  };

  const draw = (place, isDark, width) => {
    const key = place.dataset.figure;
    const figure = data.figures[`${key}-${chosen[key] || 0}`];
    const copy = themed(figure, isDark);
    place.style.height = `${copy.layout.height}px`;
    if (width) { copy.layout.width = width; copy.layout.autosize = false; }
    return Plotly.react(place, copy.data, copy.layout, settings).then(() => {
      place.dataset.drawn = isDark ? "dark" : "light";
      hide(place);
      listen(place);
    });
  };

  // A screen reader is told what the figure shows by its label and by the tables; the hundreds of
  // marks inside it say nothing.
  const hide = (place) => {
    for (const part of place.children) part.setAttribute("aria-hidden", "true");
  };

  const show = (isDark) => {
    dark = isDark;
    root.dataset.theme = dark ? "dark" : "light";
    button.textContent = dark ? "Light" : "Dark";
    button.setAttribute("aria-pressed", String(dark));
    return places.reduce(
      (before, place) => before.then(() => draw(place, dark)).then(rest), Promise.resolve());
  };
  const rest = () => new Promise((done) => setTimeout(done, 0));

  button.addEventListener("click", () => show(!dark));
  wanted.addEventListener("change", (event) => show(event.matches));
  for (const list of document.querySelectorAll("select[data-for]")) {
    list.addEventListener("change", () => choose(list.dataset.for, list.value));
  }
  const choose = (key, number) => {
    chosen[key] = number;
    const list = document.querySelector(`select[data-for="${key}"]`);
    if (list) list.value = String(number);
    return draw(document.getElementById(`figure-${key}`), dark);
  };

  // A cell of the evidence map, clicked or chosen by keyboard, shows the dependence behind it.
  const open = (target) => {
    const [key, number] = target;
    choose(key, number);
    document.getElementById(key).scrollIntoView({ block: "nearest", behavior: "smooth" });
  };
  const listen = (place) => {
    if (place.dataset.heard) return;
    place.dataset.heard = "yes";
    place.on("plotly_click", (event) => {
      const custom = event.points[0] && event.points[0].customdata;
      if (Array.isArray(custom) && custom.length >= 4 && custom[3] !== "") {
        open([custom[2], custom[3]]);
      }
    });
    place.addEventListener("keydown", (event) => keys(place, event));
  };
  for (const link of document.querySelectorAll("[data-open]")) {
    link.addEventListener("click", () => open(link.dataset.open.split(":")));
  }

  const keys = (place, event) => {
    const layout = place._fullLayout;
    const steps = {
      ArrowLeft: ["xaxis", -0.15], ArrowRight: ["xaxis", 0.15],
      ArrowDown: ["yaxis", -0.15], ArrowUp: ["yaxis", 0.15],
    };
    const change = {};
    const each = (kind, move) => {
      for (const name of Object.keys(layout)) {
        if (!/^[xy]axis\d*$/.test(name) || !name.startsWith(kind)) continue;
        if (layout[name].type === "category" || layout[name].fixedrange) continue;
        const [low, high] = layout[name].range.map(Number);
        if (!isFinite(low) || !isFinite(high)) continue;
        change[`${name}.range`] = move(low, high);
      }
    };
    const zoom = (factor) => (low, high) => {
      const middle = 0.5 * (low + high), half = 0.5 * factor * (high - low);
      return [middle - half, middle + half];
    };
    if (event.key in steps) {
      const [kind, share] = steps[event.key];
      each(kind, (low, high) => [low + share * (high - low), high + share * (high - low)]);
    } else if (event.key === "+" || event.key === "=") {
      each("", zoom(0.7));
    } else if (event.key === "-" || event.key === "−") {
      each("", zoom(1 / 0.7));
    } else if (event.key === "0") {
      event.preventDefault();
      draw(place, dark);
      return;
    } else {
      return;
    }
    event.preventDefault();
    Plotly.relayout(place, change);
  };

  // Paper is white, and narrower than a screen.
  let before = null;
  window.addEventListener("beforeprint", () => {
    if (before !== null) return;
    before = dark;
    root.dataset.theme = "light";
    for (const place of places) draw(place, false, 690);
  });
  window.addEventListener("afterprint", () => {
    if (before === null) return;
    const was = before;
    before = null;
    show(was);
  });

  window.werrimbi = { show, choose, drawn: show(dark).then(() => { root.dataset.ready = "yes"; }) };
})();
