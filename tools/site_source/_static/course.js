// Names for the arrows of the sidebar, and a place among the Tab stops for an equation that is wider than its page.
window.addEventListener("load", async () => {
  for (const arrow of document.querySelectorAll("nav summary")) {
    arrow.setAttribute("aria-label", "Pages below " + arrow.closest("li").querySelector("a").textContent.trim());
  }
  await window.MathJax?.startup?.promise;
  for (const equation of document.querySelectorAll('mjx-container[display="true"]')) {
    if (equation.scrollWidth > equation.clientWidth) equation.tabIndex = 0;
  }
});
