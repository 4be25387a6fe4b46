// Small helpers: elements, text that is only touched when it changes, numbers with their digits.
const SPACE = "http://www.w3.org/2000/svg";

export const byId = (id) => document.getElementById(id);

export function svg(name, attributes = {}, children = []) {
  const made = document.createElementNS(SPACE, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

export function html(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}

export function text(element, value) {
  if (element.textContent !== value) element.textContent = value;
}

export function attribute(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

const KEPT = 6; // digits of a number that is sent
const places = (halfWidth) => Math.min(8, Math.max(0, 1 - Math.floor(Math.log10(halfWidth))));

// A value with the digits that its half-width bears, and no more than were sent; four where there is none.
export function digits(value, halfWidth) {
  if (value === null || value === undefined) return "–";
  if (!(halfWidth > 0)) return Number(value.toPrecision(4)).toString();
  const sent = value ? Math.max(0, KEPT - 1 - Math.floor(Math.log10(Math.abs(value)))) : 8;
  return value.toFixed(Math.min(places(halfWidth), sent)).replace(/^-(0\.?0*)$/, "$1");
}

export function plusMinus(halfWidth) {
  if (!(halfWidth > 0)) return "";
  return `± ${halfWidth < 1e-4 ? halfWidth.toPrecision(2) : halfWidth.toFixed(places(halfWidth))}`;
}

// The next of 1, 2, 5, 10 ... that is not below a size.
export function nice(size) {
  if (!(size > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(size));
  return [1, 2, 5, 10].map((one) => one * power).find((one) => one >= size * 0.999999);
}

export const runsOf = (count) => (count === 1 ? "1 run" : `${count} runs`);
