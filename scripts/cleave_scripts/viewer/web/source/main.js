// Starts every viewer of the page that has not been started yet.
import {readRecordings} from './recording.js';
import {Viewer} from './viewer.js';

for (const section of document.querySelectorAll('.cleave-viewer:not([data-state])')) {
  section.dataset.state = 'loading';
  const message = section.querySelector('.cleave-message');
  try {
    section.cleaveViewer = new Viewer(section, readRecordings(section));
    section.cleaveViewer.open(0).catch((error) => fail(section, message, error));
  } catch (error) {
    fail(section, message, error);
  }
}

function fail(section, message, error) {
  section.dataset.state = 'failed';
  message.textContent = `The viewer cannot start: ${error.message}`;
  console.error(error);
}
