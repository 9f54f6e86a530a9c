// As in the page of a session, with what the desk says.

import { GERMAN as DESK } from "./desk-german.js";
import { GERMAN } from "./german.js";

export const TABLES = { de: { ...GERMAN, ...DESK } };
