"use strict";
/** Where the program `cramhy` is. */

const path = require("path");

/**
 * The program to start. setting: the user's, or "". folders: those that are open. exists: tells whether a file is there.
 * A virtual environment in an open folder comes before the PATH, since that is where the README installs it.
 */
function find(setting, folders, platform, exists) {
  if (setting) return setting;
  const inside = platform === "win32" ? ["Scripts", "cramhy.exe"] : ["bin", "cramhy"];
  for (const folder of folders) {
    for (const name of [".venv", "venv"]) {
      const candidate = path.join(folder, name, ...inside);
      if (exists(candidate)) return candidate;
    }
  }
  return "cramhy";
}

module.exports = { find };
