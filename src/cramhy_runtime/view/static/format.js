// How times and numbers are written on the page.

import { language } from "./texts.js";

const EPOCH = 1e8; // s; a clock that shows more counts from 1970

// Seconds of plan time: "4.20 s", "3:07.5", "2:03:07".
export function clock(seconds) {
  if (seconds == null || !Number.isFinite(seconds)) return "–";
  if (seconds > EPOCH) return new Date(seconds * 1000).toLocaleTimeString();
  if (seconds < 60) return `${seconds.toFixed(2)} s`;
  const minutes = Math.floor(seconds / 60);
  const rest = seconds - minutes * 60;
  if (minutes < 60) return `${minutes}:${rest.toFixed(1).padStart(4, "0")}`;
  return `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}:${String(Math.floor(rest)).padStart(2, "0")}`;
}

// How long something took: "0.3 s", "12.4 s", "3:07".
export function duration(seconds) {
  if (seconds == null || !Number.isFinite(seconds)) return "";
  if (seconds < 60) return `${seconds.toFixed(seconds < 10 ? 2 : 1)} s`;
  return clock(seconds).replace(/\.\d+$/, "");
}

// A coordinate: three decimals, never "-0.000"; what is not a number says so.
export function decimal(number, places = 2) {
  if (number == null || Number.isNaN(number)) return "NaN";
  if (!Number.isFinite(number)) return number > 0 ? "∞" : "−∞";
  const text = number.toFixed(places);
  return Number(text) === 0 ? (0).toFixed(places) : text.replace("-", "−");
}

// A count with its thousands set apart.
export const grouped = (count) => count.toLocaleString(language);

// "[GOAL-PERFORM] (GOAL (PERFORM #<A MOTION ...>)), call 2" as "[PERFORM] #<A MOTION ...>, call 2": there is one line for it.
export function shortName(name) {
  const goal = /^\[GOAL-([^\]]+)\] \(GOAL \((\S+) (.*)$/s.exec(name);
  return goal && goal[1] === goal[2] ? `[${goal[1]}] ${goal[3].replace(/\)\)(, call \d+)?$/, "$1")}` : name;
}
