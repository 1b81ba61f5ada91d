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

  // Figures have the colours of the light theme. In the dark theme each is replaced, and scales are
  // reversed, so that high values contrast with the page.
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

  // On a phone: panels and colour bars below one another, long names in two lines, and no more
  // height than equal scales can fill.
  const NARROW = 620;
  const fitted = (figure, room) => {
    const { data, layout } = figure;
    const named = (kind) => Object.keys(layout).filter((name) => name.startsWith(kind)).sort();
    layout.font = { ...layout.font, size: 12 };
    layout.margin = { ...layout.margin, l: 45, r: 12 };
    for (const note of layout.annotations || []) note.font = { ...note.font, size: 12 };
    for (const trace of data) if (trace.name) trace.name = broken(trace.name, room / 9);
    const scales = named("coloraxis").map((name) => layout[name].colorbar).filter(Boolean);
    for (const scale of scales) {
      const where = layout.showlegend ? { y: -0.16, yanchor: "top" } : { y: 1.02, yanchor: "bottom" };
      Object.assign(scale, { orientation: "h", x: 0.5, thickness: 10, ...where });
      scale.title = { text: scale.title.text.replace("<br>", " "), side: "top" };
    }
    const beside = named("xaxis").filter((name) => (layout[name].domain || [0])[0] > 0.2);
    if (beside.length) stacked(layout, named("xaxis"), named("yaxis"));
    else if (named("yaxis").some((name) => layout[name].scaleanchor)) {
      layout.height = Math.min(layout.height, Math.round(room + 90));
    }
    if (scales.length) {
      layout.margin[layout.showlegend ? "b" : "t"] = 110;
      layout.height += 60;
    }
    for (const trace of data) {
      if (trace.type === "bar" && trace.textposition === "outside" && layout.xaxis.range) {
        layout.xaxis.range[1] += 0.8 * (layout.xaxis.range[1] - layout.xaxis.range[0]);
        break;
      }
    }
  };
  const broken = (text, most) => {
    const lines = [""];
    for (const word of text.split(" ")) {
      const line = lines[lines.length - 1];
      if (line && line.length + word.length >= most) lines.push(word);
      else lines[lines.length - 1] = line ? `${line} ${word}` : word;
    }
    return lines.join("<br>");
  };
  const stacked = (layout, across, up) => {
    const each = 1 / across.length, height = 0.72 * each;
    across.forEach((name, index) => {
      const top = 1 - index * each;
      Object.assign(layout[name], { domain: [0, 1], anchor: up[index].replace("axis", "") });
      layout[up[index]].domain = [top - height, top];
      const title = (layout.annotations || [])[index];
      if (title && title.yref === "paper") Object.assign(title, { x: 0.5, y: top });
    });
    layout.height = 120 + 230 * across.length;
    layout.legend = { ...layout.legend, y: 1 + 45 / layout.height };
  };

  const settings = {
    responsive: true,
    displaylogo: false,
    showSendToCloud: false,  // plotly 4 offers to upload the figure; nobody's drives leave by us
    plotlyServerURL: "",
    modeBarButtonsToRemove: ["select2d", "lasso2d", "autoScale2d", "toggleSpikelines"],
  };

  const draw = (place, isDark, width) => {
    const key = place.dataset.figure;
    const figure = data.figures[`${key}-${chosen[key] || 0}`];
    const copy = themed(figure, isDark);
    if (width) { copy.layout.width = width; copy.layout.autosize = false; }
    const room = width || place.clientWidth;
    if (room < NARROW) fitted(copy, room);
    place.style.height = `${copy.layout.height}px`;
    return Plotly.react(place, copy.data, copy.layout, settings).then(() => {
      place.dataset.drawn = isDark ? "dark" : "light";
      hide(place);
      listen(place);
    });
  };

  // For screen readers the label and the tables have the content of the figure; its hundreds of
  // marks are hidden.
  const hide = (place) => {
    for (const part of place.children) part.setAttribute("aria-hidden", "true");
    for (const part of place.querySelectorAll("[tabindex], a, button")) part.tabIndex = -1;
  };

  // Elements that are wider than the page can also be scrolled by keys.
  const reach = () => {
    for (const part of document.querySelectorAll(".wide, pre")) {
      const wider = part.scrollWidth > part.clientWidth;
      if (wider) part.setAttribute("tabindex", "0");
      else part.removeAttribute("tabindex");
    }
  };
  window.addEventListener("resize", reach);
  reach();

  const show = (isDark) => {
    dark = isDark;
    root.dataset.theme = dark ? "dark" : "light";
    button.textContent = dark ? "Light" : "Dark";
    button.setAttribute("aria-pressed", String(dark));
    latest = drawAll(++turn, new Set(places));
    return latest;
  };

  // Figures nearest to the viewport are drawn first, with other events handled in between; a later
  // pass (theme, printing) abandons the earlier one.
  let turn = 0;
  let latest = Promise.resolve();
  const drawAll = async (mine, left) => {
    while (left.size && mine === turn) {
      const place = [...left].reduce((one, other) => (away(other) < away(one) ? other : one));
      left.delete(place);
      await draw(place, dark);
      await new Promise((done) => setTimeout(done, 0));
    }
    if (mine !== turn) await latest;
  };
  const away = (place) => {
    const seen = place.getBoundingClientRect();
    return Math.max(0, seen.top - window.innerHeight, -seen.bottom);
  };

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

  // Printing uses the light theme, and a narrower page.
  let before = null;
  window.addEventListener("beforeprint", () => {
    if (before !== null) return;
    before = dark;
    turn += 1;
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
