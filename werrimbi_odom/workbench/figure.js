// SPDX-FileCopyrightText: 2026 The werrimbi_odom authors
// SPDX-License-Identifier: Apache-2.0
// A figure: drawn when plotly.js is loaded, with the width of its container, and purged with it.
const program = () => new Promise((done) => {
  const look = () => (window.Plotly ? done(window.Plotly) : setTimeout(look, 20));
  look();
});

export default {
  template: "<div></div>",
  props: { figure: Object },
  async mounted() {
    const Plotly = await program();
    if (!this.$el.isConnected) return;  // redrawn meanwhile
    const { data, layout, config } = this.figure;
    await Plotly.newPlot(this.$el, data, layout, config);
    // For screen readers: the label and the tables have the content; marks and tool bar are noise.
    for (const part of this.$el.children) part.setAttribute("aria-hidden", "true");
    for (const part of this.$el.querySelectorAll("[tabindex], a, button")) part.tabIndex = -1;
    this.watcher = new ResizeObserver(() => {
      if (this.$el.offsetParent !== null) Plotly.Plots.resize(this.$el);
    });
    this.watcher.observe(this.$el);
  },
  unmounted() {
    this.watcher?.disconnect();
    window.Plotly?.purge(this.$el);
  },
};
