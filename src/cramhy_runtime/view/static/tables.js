// The languages that the page speaks beside English: what it says, by what it says in English. The site of `cramhy browser` has a module of
// this name of its own, with what the desk says.

import { GERMAN } from "./german.js";

export const TABLES = { de: GERMAN };
