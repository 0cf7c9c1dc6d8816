// Messages between page and server; src/crumple/app/client.py describes them.
export interface Problem {
  what: string; came: string; allowed: string; todo: string; where: string; file: string; line: number;
}
export interface Numeral { path: string; start: number; end: number; value: number; unit: string }
export interface Word { path: string; start: number; end: number; text: string }
/** Drawing, capacities and curves of a section or a law. */
export interface Form { path: string; title: string; drawing: string; rows: [string, string][]; curves: { caption: string; svg: string }[] }
/** Least and greatest values of curves from the bands of the laws. */
export interface Bands {
  curves: { name: string; unit: string; low: number[]; high: number[] }[];
  laws: number; without: number; failed: number;
}
export interface Curve { name: string; unit: string; values: number[][] }
export interface Answer {
  problems?: Problem[];
  more?: number;
  numbers?: Numeral[];
  words?: Word[];
  scene?: { header: string; payload: string } | null;
  level?: string;
  headline?: string;
  sentences?: string[];
  cautions?: string[];
  more_cautions?: number;
  curves?: { end: number; samples: number; all: Curve[] };
  seconds?: number;
  failed?: string;
  stopped?: boolean;
}
export interface Figure { caption: string; panels: { name: string; svg: string }[] }
export type Received =
  | { kind: "welcome"; folder: string; files: string[]; starts: { name: string; title: string }[]; first: string; schema: Schema }
  | { kind: "opened"; name: string; text: string; seen: string; draft: string | null }
  | ({ kind: "answer"; number: number } & Answer)
  | { kind: "figures"; number: number; figures?: Figure[] }
  | { kind: "forms"; number: number; forms?: Form[] }
  | { kind: "bands"; number: number; bands?: Bands | null }
  | { kind: "saved"; name: string; seen: string; files: string[] }
  | { kind: "kept" }
  | { kind: "code"; code: string }
  | { kind: "progress"; share: number }
  | ({ kind: "shell" } & Answer)
  | { kind: "refused"; of?: string; what: string };

/** JSON Schema, as far as completion reads it. */
export interface Schema {
  $ref?: string;
  $defs?: Record<string, Schema>;
  properties?: Record<string, Schema>;
  additionalProperties?: boolean | Schema;
  items?: Schema;
  anyOf?: Schema[];
  oneOf?: Schema[];
  allOf?: Schema[];
  enum?: unknown[];
  const?: unknown;
  description?: string;
}
