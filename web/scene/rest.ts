export { REST, REST_HEIGHT } from '../core/rest';
