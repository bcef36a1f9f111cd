// Files that the page makes.

/** Saves the parts of a file under a name. */
export function download(name, parts, options) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob(parts, options));
  link.download = name;
  link.click();
  // Later, because the browser may still be reading it.
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
