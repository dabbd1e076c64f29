// A browser lets no page of the file system read the index of the search: say how to serve the site instead.
if (location.protocol === "file:") {
  const site = decodeURIComponent(new URL(SAID.site, document.currentScript.src).pathname);
  const note = document.createElement("p");
  const command = document.createElement("code");
  command.textContent = `${SAID.command} "${site.replace(/^\/(?=[A-Za-z]:)/, "").replace(/\/$/, "")}"`;
  note.append(`${SAID.words} `, command);
  (document.querySelector("article") ?? document.body).prepend(note);
}
