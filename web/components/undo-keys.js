/** Ctrl+Z and Ctrl+Shift+Z (or Ctrl+Y) for a page's state; on a Mac the command key. */

/**
 * @param {{undo: () => void, redo: () => void}} store
 * @returns {() => void} takes them back
 */
export function bindUndoKeys(store) {
  /** @param {KeyboardEvent} event */
  function key(event) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const pressed = event.key.toLowerCase();
    const back = pressed === "z" && !event.shiftKey;
    const forth = pressed === "y" || (pressed === "z" && event.shiftKey);
    if (!back && !forth) return;
    // Text being typed has an undo of its own.
    const target = event.target;
    if (target instanceof HTMLInputElement && target.type === "text") return;
    event.preventDefault();
    if (back) store.undo();
    else store.redo();
  }
  addEventListener("keydown", key);
  return () => removeEventListener("keydown", key);
}
