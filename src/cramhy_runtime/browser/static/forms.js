// Forms of Lisp and Hy in a text: the one at a place, the language and the package there, and whether a text is complete.

const TOKEN = new RegExp(
  [
    /;[^\n]*/, // comments
    /#\|[\s\S]*?(?:\|#|$)/,
    /#\[([^[\]]*)\[[\s\S]*?(?:\]\1\]|$)/, // strings, Hy's between brackets too
    /"(?:\\[\s\S]|[^"\\])*(?:"|$)/,
    /#\\(?:[\w-]+|[\s\S])/, // characters of Lisp
    /\|[^|\n]*\|/, // names with anything in them
    /[()[\]{}]/,
  ]
    .map(({ source }) => source)
    .join("|"),
  "g",
);
const CLOSES = { ")": "(", "]": "[", "}": "{" };
const CHANGES = /^\s*\((?:(?:cl:|common-lisp:)?in-package\s+[#:'"]*([^\s()"]+)"?\s*|in-hy\s*)\)/gim;

// [{start, end}] of the top-level lists of a text that are closed, and where the first one begins that is not (or null).
function lists(text) {
  const closed = [];
  let open = [];
  for (const { 0: token, index } of text.matchAll(TOKEN)) {
    if ("([{".includes(token)) {
      // A bracket at the left margin begins a new form, also where one before it is not closed.
      if (open.length && (index === 0 || text[index - 1] === "\n")) open = [];
      open.push({ token, index });
    } else if (CLOSES[token] && open.length) {
      const { token: opened, index: start } = open.pop();
      if (opened !== CLOSES[token]) open = [];
      else if (!open.length) closed.push({ start, end: index + 1 });
    }
  }
  return { closed, open: open[0]?.index ?? null };
}

// {start, text} of the top-level form at an offset, or right before it; null if there is none.
export function formAt(text, offset) {
  const { closed } = lists(text);
  const found =
    closed.find(({ start, end }) => start <= offset && offset < end) ??
    closed.filter(({ end }) => end <= offset && !text.slice(end, offset).trim()).at(-1);
  return found ? { start: found.start, text: text.slice(found.start, found.end) } : null;
}

// {language, name} at an offset of a file: "lisp" or "hy", and the package, null before any in-package.
export function surroundings(text, offset, path) {
  let found = { language: path.endsWith(".hy") ? "hy" : "lisp", name: null };
  for (const match of text.matchAll(CHANGES)) {
    if (match.index >= offset) break;
    found = match[1] ? { language: "lisp", name: match[1] } : { language: "hy", name: null };
  }
  return found;
}

// Where the top-level form begins that an offset is in, closed or not.
export const topStart = (text, offset) => Math.max(0, text.lastIndexOf("\n(", offset - 1) + 1);

// Whether a list, a string or a comment is open at the end of a text.
export function isOpen(text) {
  let depth = 0;
  for (const { 0: token } of text.matchAll(TOKEN)) {
    if ("([{".includes(token)) depth++;
    else if (CLOSES[token]) depth--;
    else if (token.startsWith('"') && !/^"(?:\\[\s\S]|[^"\\])*"$/.test(token)) return true;
    else if (token.startsWith("#|") && !token.endsWith("|#")) return true;
    else if (token.startsWith("#[") && !/\]$/.test(token)) return true;
    if (depth < 0) return false;
  }
  return depth > 0;
}

// A string of Lisp.
export const literal = (text) => `"${text.replace(/[\\"]/g, "\\$&")}"`;
