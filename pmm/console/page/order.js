// An item of a list that is dragged to another's place, or moved with Alt and the arrow keys.
import { html } from "./svg.js";

export function movable(key, { order, move, remove }, ...children) {
  const item = html("li", { draggable: "true", tabindex: "0", "data-key": key }, ...children);
  const place = () => order().indexOf(key);
  item.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (event.target !== item) return; // a field of its own is typed in
    if (event.key === "Delete") remove(key);
    else if (step && event.altKey) move(key, place() + step);
    else return;
    event.preventDefault();
  });
  item.addEventListener("dragstart", (event) => {
    event.stopPropagation(); // an item within an item is dragged alone
    event.dataTransfer.setData("text/plain", String(key));
  });
  item.addEventListener("dragover", (event) => event.preventDefault());
  item.addEventListener("drop", (event) => {
    event.preventDefault();
    event.stopPropagation();
    const dragged = order().find((one) => String(one) === event.dataTransfer.getData("text/plain"));
    if (dragged !== undefined) move(dragged, place());
  });
  return item;
}
