import { create } from 'zustand';
import { Role } from '../gen/visionserver/v1/session_pb';

const kStorageKey = 'visionserver.session';

/** Who is logged in, as the server says. */
export interface Login {
  /** Secret of the session; goes into `authorization: Bearer TOKEN`. */
  token: string;
  user: string;
  role: Role;
  sessionId: string;
  /** Only ChangePassword, WhoAmI and Logout work until the one-time password is changed. */
  mustChangePassword: boolean;
}

interface SessionState {
  login: Login | null;
  /** The server refused the token while pages were open: a dialog asks for the password. */
  expired: boolean;
  setLogin: (login: Login) => void;
  setExpired: () => void;
  clear: () => void;
}

/** Null also where something else has written there: the user logs in again. */
function load(): Login | null {
  try {
    return JSON.parse(sessionStorage.getItem(kStorageKey) ?? 'null') as Login | null;
  } catch {
    sessionStorage.removeItem(kStorageKey);
    return null;
  }
}

/** The session of this tab. It survives a reload (sessionStorage) but not the closing of the tab. */
export const useSession = create<SessionState>()((set) => ({
  login: load(),
  expired: false,
  setLogin: (login) => {
    sessionStorage.setItem(kStorageKey, JSON.stringify(login));
    set({ login, expired: false });
  },
  setExpired: () => set((state) => (state.login ? { expired: true } : {})),
  clear: () => {
    sessionStorage.removeItem(kStorageKey);
    set({ login: null, expired: false });
  },
}));

/** The role of who is logged in; ROLE_UNSPECIFIED for nobody. */
export function useRole(): Role {
  return useSession((state) => state.login?.role ?? Role.UNSPECIFIED);
}

/** May start and stop sequences and set the parameters meant for operators. */
export function mayOperate(role: Role): boolean {
  return role === Role.OPERATOR || role === Role.ENGINEER || role === Role.ADMIN;
}

/** May edit sequences, cameras and all parameters. */
export function mayEngineer(role: Role): boolean {
  return role === Role.ENGINEER || role === Role.ADMIN;
}

/** May manage users, sessions and keys, and read the audit. */
export function isAdmin(role: Role): boolean {
  return role === Role.ADMIN;
}
