// SPDX-License-Identifier: BSD-3-Clause
// HTML without markup in strings: text from messages stays text.

/** element("td", {class: "bad"}, "text", otherElement) */
export function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [attribute, value] of Object.entries(attributes)) made.setAttribute(attribute, value);
  made.append(...children);
  return made;
}
