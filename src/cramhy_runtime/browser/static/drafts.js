// What was typed into the editor and is not in the folder yet. It survives a tab that is closed, and Python when that has stopped.

const PREFIX = "cramhy-draft:";

export function keepDraft(path, text) {
  try {
    localStorage.setItem(PREFIX + path, text);
  } catch {
    // a private window, or no room: the folder has it in a moment
  }
}

// TEXT is in the folder. A draft that is newer stays.
export function dropDraft(path, text = null) {
  try {
    if (text === null || localStorage.getItem(PREFIX + path) === text) localStorage.removeItem(PREFIX + path);
  } catch {
    // as above
  }
}

// [[path, text]] of all drafts.
export function drafts() {
  try {
    return Object.entries(localStorage)
      .filter(([key]) => key.startsWith(PREFIX))
      .map(([key, text]) => [key.slice(PREFIX.length), text]);
  } catch {
    return [];
  }
}
