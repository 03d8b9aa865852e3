/** The custom elements of the pages, so that the type checker knows what making one gives. */

interface HTMLElementTagNameMap {
  "gain-slider": import("./components/gain-slider.js").GainSlider;
  "number-field": import("./components/number-field.js").NumberField;
  "plant-schematic": import("./components/plant-schematic.js").PlantSchematic;
  "segmented-control": import("./components/segmented-control.js").SegmentedControl;
  "status-toast": import("./components/status-toast.js").StatusToast;
}
