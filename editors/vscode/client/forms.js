"use strict";
/** Forms of Lisp and Hy in a text: the one at the cursor, the package that it is in, and how it is sent to a prompt. */

const TOKEN = /;[^\n]*|#\|[\s\S]*?(?:\|#|$)|"(?:\\[\s\S]|[^"\\])*(?:"|$)|#\\(?:[\w-]+|[\s\S])|\|[^|]*\||[()[\]{}]/g;
const CLOSES = { ")": "(", "]": "[", "}": "{" };

/** [{start, end}] of the top-level lists of a text that are closed. */
function topLevel(text) {
  const found = [];
  let open = [];
  for (const match of text.matchAll(TOKEN)) {
    const token = match[0];
    if ("([{".includes(token)) {
      // A bracket at the left margin begins a new form, also where one before it is not closed.
      if (open.length && (match.index === 0 || text[match.index - 1] === "\n")) open = [];
      open.push({ token, index: match.index });
    } else if (CLOSES[token] && open.length) {
      const { token: opened, index } = open.pop();
      if (opened !== CLOSES[token]) open = [];
      else if (!open.length) found.push({ start: index, end: match.index + 1 });
    }
  }
  return found;
}

/** The top-level form at an offset, or right before it; "" if there is none. */
function formAt(text, offset) {
  const lists = topLevel(text);
  const inside = lists.find((each) => each.start <= offset && offset < each.end);
  const before = lists.filter((each) => each.end <= offset && !text.slice(each.end, offset).trim()).pop();
  const chosen = inside || before;
  return chosen ? text.slice(chosen.start, chosen.end) : "";
}

/** The name of the package that is current at an offset, or "" before any in-package. */
function packageAt(text, offset) {
  let found = "";
  for (const match of text.matchAll(/^\s*\((?:cl:|common-lisp:)?in-package\s+[#:'"]*([^\s()"]+)"?\s*\)/gim)) {
    if (match.index < offset) found = match[1];
  }
  return found;
}

/** A string of Lisp. */
function literal(text) {
  return `"${text.replace(/[\\"]/g, "\\$&")}"`;
}

/** The lines to send to a prompt for a form of a package. Blank lines would end what is typed at some prompts, so they go. */
function forPrompt(form, name) {
  const lines = form.split(/\r?\n/).filter((line) => line.trim());
  return name ? [`(cl:in-package ${literal(name.toUpperCase())})`, ...lines] : lines;
}

module.exports = { topLevel, formAt, packageAt, literal, forPrompt };
