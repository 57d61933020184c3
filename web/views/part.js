/** The choice of the part that this page plays, where a server has several. */

/** @typedef {import('../sound/server_connection.js').ServerConnection} ServerConnection */

import { find } from "../elements.js";
import { onLanguage, translate } from "../i18n.js";

/** @param {ServerConnection} line */
export function showPart(line) {
  const select = find("part", HTMLSelectElement);
  const tell = () => {
    const { part, parts } = line.status;
    select.hidden = parts < 2;
    if (select.length !== parts) {
      select.replaceChildren(
        ...Array.from({ length: parts }, (_, i) => new Option("", String(i + 1))),
      );
    }
    for (const option of select.options)
      option.text = translate("part.of", { part: option.value, parts });
    select.value = String(part);
    document.title = parts < 2 ? translate("title") : `${translate("title")} ${part}`;
  };
  select.addEventListener("change", () => {
    const url = new URL(location.href);
    url.searchParams.set("part", select.value);
    location.assign(url); // a player of its own, that knows nothing of the part before
  });
  line.addEventListener("status", tell);
  onLanguage(tell);
}
