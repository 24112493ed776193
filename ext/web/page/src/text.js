// SPDX-License-Identifier: LGPL-2.1-or-later
// The texts of the page in English and German. In the page, the attribute data-text names the text
// of an element, data-title its tooltip, and data-label its label for screen readers.

const TEXTS = {
  scene: [
    'Point cloud. Arrow keys turn, plus and minus zoom, 0 goes home.',
    'Punktwolke. Pfeiltasten drehen, Plus und Minus zoomen, 0 geht zurück.',
  ],
  scale: ['Colour scale', 'Farbskala'],
  view: ['View', 'Ansicht'],
  colour: ['Colour by', 'Farbe nach'],
  robot: ['Robot', 'Roboter'],
  follow: ['Follow', 'Folgen'],
  follow_title: ['The camera goes with the sensor (F)', 'Die Kamera geht mit dem Sensor (F)'],
  map: ['Map', 'Karte'],
  map_title: ['What odometry has seen so far (M)', 'Was die Odometrie bisher sah (M)'],
  trail: ['Trail', 'Spur'],
  trail_title: ['Points stay for a second (T)', 'Punkte bleiben eine Sekunde (T)'],
  measure: ['Measure', 'Messen'],
  measure_title: ['Distance between two points (R)', 'Abstand zweier Punkte (R)'],
  measure_first: ['Choose a point', 'Einen Punkt wählen'],
  measure_second: ['Choose the other point', 'Den anderen Punkt wählen'],
  top: ['Top', 'Oben'],
  top_title: ['Look from above (O)', 'Von oben sehen (O)'],
  pause: ['Pause', 'Pause'],
  pause_title: ['Hold the picture (Space)', 'Das Bild anhalten (Leertaste)'],
  snapshot: ['Snapshot', 'Foto'],
  snapshot_title: ['Save the picture as PNG (S)', 'Das Bild als PNG sichern (S)'],
  panel: ['Charts', 'Kurven'],
  panel_title: ['Charts (C)', 'Kurven (C)'],
  theme: ['Theme', 'Hell/Dunkel'],
  theme_title: ['Dark or light (D)', 'Dunkel oder hell (D)'],
  time: ['Time', 'Zeit'],
  back: ['−10 s', '−10 s'],
  back_title: ['Ten seconds back (B)', 'Zehn Sekunden zurück (B)'],
  forth: ['+10 s', '+10 s'],
  forth_title: ['Ten seconds on (N)', 'Zehn Sekunden weiter (N)'],
  live_title: ['Back to what is now (L)', 'Zurück zum Jetzt (L)'],
  past: ['Recorded', 'Aufgezeichnet'],
  loading: ['Loading the recording', 'Lädt die Aufzeichnung'],
  recording_broken: [
    'The recording on the server cannot be read.',
    'Die Aufzeichnung auf dem Server ist nicht lesbar.',
  ],
  recording_damaged: ['Damaged parts of the recording are left out.', 'Beschädigte Teile der Aufzeichnung fehlen.'],
  ago: ['ago', 'her'],
  more: ['More', 'Mehr'],
  more_title: ['All controls', 'Alle Bedienelemente'],
  clip_low: ['Show from [m]', 'Zeigen ab [m]'],
  clip_high: ['Show up to [m]', 'Zeigen bis [m]'],
  statistics: ['Statistics of the pipeline', 'Zahlen der Pipeline'],
  entry: ['A token is needed', 'Ein Token ist nötig'],
  entry_text: [
    'This server lets in who knows the token of its foxglovesink.',
    'Dieser Server lässt ein, wer das Token seines foxglovesink kennt.',
  ],
  token: ['Token', 'Token'],
  connect: ['Connect', 'Verbinden'],
  camera: ['Camera', 'Kamera'],

  height: ['Height', 'Höhe'],
  intensity: ['Intensity', 'Intensität'],
  range: ['Range', 'Entfernung'],
  beam: ['Beam', 'Strahl'],
  age: ['Age', 'Alter'],

  connecting: ['Connecting', 'Verbindet'],
  live: ['Live', 'Live'],
  stalled: ['No clouds', 'Keine Wolken'],
  stalled_text: ['Connected, but no cloud has come for two seconds.', 'Verbunden, aber seit zwei Sekunden kam keine Wolke.'],
  lost: ['Connection lost', 'Verbindung verloren'],
  lost_text: ['The server does not answer. Trying again.', 'Der Server antwortet nicht. Neuer Versuch.'],
  refused: ['Not admitted', 'Nicht eingelassen'],
  refused_text: ['The token is missing or wrong.', 'Das Token fehlt oder ist falsch.'],
  expired: ['Token expired', 'Token abgelaufen'],
  expired_text: ['The token has expired. Enter a new one.', 'Das Token ist abgelaufen. Ein neues eingeben.'],
  foreign: ['Not admitted', 'Nicht eingelassen'],
  foreign_text: ['The server serves pages of another address.', 'Der Server bedient Seiten einer anderen Adresse.'],
  limited: ['Too many attempts', 'Zu viele Versuche'],
  limited_text: ['The server lets nobody in for a while. Trying again.', 'Der Server lässt eine Weile niemanden ein. Neuer Versuch.'],
  full: ['Server is full', 'Server ist voll'],
  full_text: ['Too many viewers are connected. Trying again.', 'Zu viele Betrachter sind verbunden. Neuer Versuch.'],
  paused: ['paused', 'angehalten'],
  old: ['old', 'alt'],
  to_page: ['to this page', 'zu dieser Seite'],

  Bitrate: ['Bitrate', 'Bitrate'],
  Delay: ['Delay', 'Verzögerung'],
  Window: ['Window', 'Fenster'],
  Precision: ['Precision', 'Genauigkeit'],
  Losses: ['Losses', 'Verluste'],
  'Age of the cloud': ['Age of the cloud', 'Alter der Wolke'],
  'To this page': ['To this page', 'Zu dieser Seite'],
  Links: ['Links', 'Verbindungen'],
  'Round trip of links': ['Round trip of links', 'Hin und zurück je Verbindung'],
  'Queue of links': ['Queue of links', 'Warteschlange je Verbindung'],
  unusable: ['not usable', 'nicht nutzbar'],
  in_gap: ['in a gap', 'in einer Lücke'],
  'since the start': ['since the start', 'seit dem Start'],
  capacity: ['capacity', 'Kapazität'],
  target: ['target', 'Ziel'],
  sent: ['sent', 'gesendet'],
  'round trip': ['round trip', 'hin und zurück'],
  queue: ['queue', 'Warteschlange'],
  'allowed in flight': ['allowed in flight', 'unterwegs erlaubt'],
  'in flight': ['in flight', 'unterwegs'],
  step: ['step', 'Raster'],
  'largest error': ['bound of the error', 'Fehlerschranke'],
  'packets lost': ['packets lost', 'Pakete verloren'],
  marked: ['marked', 'markiert'],
  'slices lost': ['slices lost', 'Sektoren verloren'],
  'Deviation of the pose': ['Deviation of the pose', 'Abweichung der Pose'],
  position: ['position', 'Position'],
  Poses: ['Poses', 'Posen'],
  'poses lost': ['lost', 'verloren'],
  degenerate: ['degenerate', 'unbestimmt'],
  received: ['received', 'empfangen'],
  drawn: ['when drawn', 'beim Zeichnen'],
  link: ['link', 'Verbindung'],
};

const asked = new URLSearchParams(globalThis.location?.search).get('lang') ?? globalThis.navigator?.language ?? 'en';
export const language = asked.startsWith('de') ? 'de' : 'en';

export const t = (name) => TEXTS[name]?.[language === 'de' ? 1 : 0] ?? name;

/** Formats a number by the rules of the language. */
export const number = (value, digits = 0) =>
  value.toLocaleString(language, { minimumFractionDigits: digits, maximumFractionDigits: digits });

export function translate(root) {
  document.documentElement.lang = language;
  for (const element of root.querySelectorAll('[data-text]')) element.textContent = t(element.dataset.text);
  for (const element of root.querySelectorAll('[data-title]')) element.title = t(element.dataset.title);
  for (const element of root.querySelectorAll('[data-label]'))
    element.setAttribute('aria-label', t(element.dataset.label));
}
