// What every page has besides the viewer.
import "./figures";
import "./copy";
