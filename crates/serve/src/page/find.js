// Which cameras meet the scenario of the page: a search of seconds, which is asked for by itself and can be stopped.
"use strict";

const FIND_SAYS = "The scene, the alternatives and the requirement stay; camera, filters and frames are left open.";
let searching = null;
// The text that was searched for; what is shown belongs to it alone.
let searched = null;

async function search() {
  if (searching) return searching.abort();
  searching = new AbortController();
  const asked = text;
  const begun = Date.now();
  at("ask-find").textContent = "Stop the search";
  at("find-says").textContent = "Searching.";
  const clock = setInterval(() => { at("find-says").textContent = `Searching: ${Math.round((Date.now() - begun) / 1000)} s.`; }, 5000);
  let said = FIND_SAYS;
  try {
    const reply = await post("/find", { scenario: asked }, AbortSignal.any([searching.signal, AbortSignal.timeout(LONGEST_MS)]));
    if (!reply.ok) said = `The program says: ${await reply.text()}`;
    else {
      const { answer, error } = await reply.json();
      if (error) said = `No search: ${error.message}`;
      else if (asked !== text) said = "The scenario has changed meanwhile: search again.";
      else {
        searched = asked;
        showFound(answer);
      }
    }
  } catch {
    said = searching.signal.aborted ? "Stopped." : "The program does not answer.";
  }
  clearInterval(clock);
  searching = null;
  at("ask-find").textContent = "Search the cameras of the program";
  at("find-says").textContent = said;
}

function showFound({ sentence, rows, text: printed }) {
  at("find-sentence").textContent = sentence;
  at("find-rows").replaceChildren(...rows.map((one) => element(
    "tr", {}, element("th", { scope: "row" }, one.camera),
    element("td", {}, element("strong", {}, one.told), ...(one.why ? [element("small", {}, ` ${one.why}`)] : [])),
    ...[one.distance, one.lens, one.filters, one.frames, one.time, one.price].map((value) => cell(value || "-")),
    element("td", {}, ...(one.scenario ? [button("Take it", () => taken(one.scenario), { className: "small", "aria-label": `Take it: ${one.camera} with ${one.lens}` })] : [])),
  )));
  at("find-text").textContent = printed;
  at("found").hidden = false;
}

// One of the choices: the scene is still the one that was searched for.
function taken(scenario) {
  searched = scenario;
  take(scenario);
}

// What was found of another scenario is no answer to this one.
function forgetFound() {
  if (searched === null || searched === text) return;
  searched = null;
  at("found").hidden = true;
}

at("ask-find").addEventListener("click", search);
