/* The chain protocol (core/chain) for a few modules, small enough that every run of it is looked at.
 *
 * A claim register is known by its version: what was written under it stands in `content`. The radio has no state
 * for claims: whatever was ever sent may arrive, at any time, any number of times, or never. Of announcements the
 * present one may be heard, and one from the past that was kept on the way. Time is left out: a start may have come
 * at any look, and any member may seem silent at any look. An epoch is the versions it is taken over, not their hash.
 */
#ifndef N
#define N 3         /* modules */
#endif
#ifndef DOCKS
#define DOCKS 1     /* how often each may happen in a run */
#endif
#ifndef UNDOCKS
#define UNDOCKS 0
#endif
#ifndef CRASHES
#define CRASHES 0
#endif
#ifndef LATE
#define LATE 0      /* announcements kept on the way */
#endif
#ifndef LINKED
#define LINKED 0    /* at first, and agreed: 1: males of 0, 2 in the next one; 2: every male in the next one */
#endif
#ifndef FEWER
#define FEWER 0     /* 1: fewer runs: nobody seems silent who is not, and what is said of another epoch is lost */
#endif
#ifndef ROUNDS
#define ROUNDS 3    /* without loss, after which all agree */
#endif

#define NONE 255
#define MALE(m) (2 * (m))
#define FEMALE(m) (2 * (m) + 1)
#define OWNER(r) ((r) / 2)
#define REGISTERS (2 * N)
#define VERSIONS 6  /* 1..5; three bits in an epoch */
#define CONTENT(r, v) content[(r) * VERSIONS + (v)]
#define KNOWN(j, r) known[(j) * REGISTERS + (r)]
#define VERSION_IN(epoch, r) (((epoch) >> (3 * (r))) & 7)
#define AT(j, m) ((j) * N + (m))

/* What is so. */
byte mate[N];                             /* whose female port a male port is in; NONE */
bool live[N];
bool silent[N];                           /* down for so long that all have noticed */
byte docks, undocks, crashes, late;       /* so far */
bool quiet;                               /* the run is over */

/* Claims. */
byte latest[REGISTERS];                   /* version last written */
byte content[REGISTERS * VERSIONS];       /* peer + 1; 0: withdrawn */
bool spoken[REGISTERS];                   /* written since its owner started */
byte birth[REGISTERS];                    /* version last written before its owner started */
byte known[N * REGISTERS];

/* Agreement. Level: 1 proposed, 2 with a start, 3 active. */
bool holds[N], flies[N], started[N], decides[N];
int held[N], flown[N];
int heard[N * N];                         /* epoch */
byte level[N * N];
int late_epoch[N];                        /* what is kept on the way, by sender */
byte late_level[N];
bool past[N * N];                         /* heard something newer than that */

/* Within one step only. */
hidden byte version[REGISTERS];
hidden byte members[N];
hidden byte inside[N];
hidden byte count, at, who, whom, i, k, r, other, said_level, turn;
hidden int epoch, said;
hidden byte ring, ready, fresh, one_active, spoke, same;

#define LINK_OF_MALE(m) (version[MALE(m)] != 0 && CONTENT(MALE(m), version[MALE(m)]) != 0)
#define PEER_OF_MALE(m) (CONTENT(MALE(m), version[MALE(m)]) - 1)
#define PEER_OF_FEMALE(m) (CONTENT(FEMALE(m), version[FEMALE(m)]) - 1)
#define MALE_LINKED(m) (LINK_OF_MALE(m) && version[FEMALE(PEER_OF_MALE(m))] != 0 && \
  CONTENT(FEMALE(PEER_OF_MALE(m)), version[FEMALE(PEER_OF_MALE(m))]) == (m) + 1)
#define FEMALE_LINKED(m) (version[FEMALE(m)] != 0 && CONTENT(FEMALE(m), version[FEMALE(m)]) != 0 && \
  version[MALE(PEER_OF_FEMALE(m))] != 0 && CONTENT(MALE(PEER_OF_FEMALE(m)), version[MALE(PEER_OF_FEMALE(m))]) == (m) + 1)

/* `members`, from the one whose female port is free, as `version` has them linked. */
inline arrange(j) {
  at = j; count = 0; ring = false;
  do
  :: FEMALE_LINKED(at) && PEER_OF_FEMALE(at) != j -> at = PEER_OF_FEMALE(at)
  :: FEMALE_LINKED(at) && PEER_OF_FEMALE(at) == j -> ring = true; break
  :: else -> break
  od;
  for (i : 0 .. N - 1) { inside[i] = false }
  if
  :: ring
  :: else ->
    do
    :: members[count] = at; inside[at] = true; count++;
      if
      :: MALE_LINKED(at) -> at = PEER_OF_MALE(at)
      :: else -> break
      fi
    od
  fi
}

/* `epoch` of the members: over their claims, and the claims these point at. */
inline take_epoch() {
  epoch = 0;
  for (r : 0 .. REGISTERS - 1) {
    if
    :: inside[OWNER(r)] -> epoch = epoch | (version[r] << (3 * r))
    :: else
    fi
  }
  for (i : 0 .. N - 1) {
    if
    :: inside[i] && LINK_OF_MALE(i) && !inside[PEER_OF_MALE(i)] ->
      r = FEMALE(PEER_OF_MALE(i)); epoch = epoch | (version[r] << (3 * r))
    :: else
    fi;
    if
    :: inside[i] && version[FEMALE(i)] != 0 && CONTENT(FEMALE(i), version[FEMALE(i)]) != 0 &&
       !inside[PEER_OF_FEMALE(i)] ->
      r = MALE(PEER_OF_FEMALE(i)); epoch = epoch | (version[r] << (3 * r))
    :: else
    fi
  }
  if
  :: count == 1 -> epoch = 0
  :: else
  fi
}

inline tell(j) {
  if
  :: holds[j] && flies[j] && flown[j] == held[j] -> said = held[j]; said_level = 3
  :: holds[j] && !(flies[j] && flown[j] == held[j]) -> said = held[j]; said_level = 1 + started[j]
  :: !holds[j] && flies[j] -> said = flown[j]; said_level = 3
  :: else -> said = 0; said_level = 0
  fi;
  if
  :: said == 0 -> said_level = 0   /* nobody asks a single module */
  :: else
  fi
}

/* What can make no difference any more is forgotten, so that it does not tell states apart: an epoch that can never
 * be held again, since what j knows only grows, and what was said of one on which j needs to hear no more. */
inline forget_heard(j, m) {
  said = heard[AT(j, m)]; said_level = level[AT(j, m)];
  if
  :: flies[j] && said == flown[j] -> said = 0
  :: else ->
    if
    :: holds[j] && said == held[j] && said_level < (started[j] -> 3 : (decides[j] -> 1 : 2)) -> said = 0
    :: else ->
      for (r : 0 .. REGISTERS - 1) {
        if
        :: VERSION_IN(said, r) != 0 && VERSION_IN(said, r) < KNOWN(j, r) -> said = 0; break
        :: else
        fi
      }
    fi
  fi;
  if
  :: said == 0 -> heard[AT(j, m)] = 0; level[AT(j, m)] = 0
  :: else
  fi
}

inline forget(j) {
  for (k : 0 .. N - 1) {
    if
    :: heard[AT(j, k)] != 0 -> forget_heard(j, k)
    :: else
    fi
  }
}

/* Never: a view without all its members; one that goes back; a link lost without its latch; a silent start. */
inline watch_activation(j, silence_matters) {
  assert(inside[j]);
  for (i : 0 .. N - 1) {
    if
    :: inside[i] && epoch != 0 -> assert(!(silence_matters && silent[i]));
      if
      :: live[i] && VERSION_IN(epoch, MALE(i)) > birth[MALE(i)] && VERSION_IN(epoch, FEMALE(i)) > birth[FEMALE(i)] ->
        for (r : 0 .. REGISTERS - 1) { assert(KNOWN(i, r) >= VERSION_IN(epoch, r)) }
      :: else
      fi
    :: else
    fi
  }
  if
  :: flies[j] && flown[j] != 0 ->
    for (r : 0 .. REGISTERS - 1) {
      assert(VERSION_IN(epoch, r) == 0 || VERSION_IN(epoch, r) >= VERSION_IN(flown[j], r))
    }
    /* The links flown before: both ends among the versions of that epoch. */
    for (i : 0 .. N - 1) {
      r = VERSION_IN(flown[j], MALE(i));
      if
      :: r != 0 && CONTENT(MALE(i), r) != 0 ->
        k = CONTENT(MALE(i), r) - 1;
        if
        :: VERSION_IN(flown[j], FEMALE(k)) != 0 && CONTENT(FEMALE(k), VERSION_IN(flown[j], FEMALE(k))) == i + 1 &&
           !(MALE_LINKED(i) && PEER_OF_MALE(i) == k) ->
          assert(version[MALE(i)] > r || version[FEMALE(k)] > VERSION_IN(flown[j], FEMALE(k)))
        :: else
        fi
      :: else
      fi
    }
  :: else
  fi
}

/* Never: two starts of one epoch. */
inline watch_decision(j) {
  for (i : 0 .. N - 1) {
    assert(!(flies[i] && flown[i] == epoch) && !(holds[i] && held[i] == epoch && started[i]));
    assert(!(late_epoch[i] == epoch && late_level[i] >= 2));
    for (k : 0 .. N - 1) { assert(!(heard[AT(k, i)] == epoch && level[AT(k, i)] >= 2)) }
  }
}

/* One period of Agreement::update. `seems_fresh`: no member seems silent; `come`: the start has come. */
inline update(j, seems_fresh, come) {
  if
  :: spoken[MALE(j)] && spoken[FEMALE(j)] ->
    for (r : 0 .. REGISTERS - 1) { version[r] = KNOWN(j, r) }
    arrange(j);
    if
    :: ring -> holds[j] = false; held[j] = 0; started[j] = false; decides[j] = false
    :: else ->
      take_epoch();
#ifdef MUTATION_ALL_DECIDE
      decides[j] = epoch != 0;
#else
      decides[j] = epoch != 0 && members[(count + 1) / 2 - 1] == j;
#endif
      if
      :: !holds[j] || held[j] != epoch -> holds[j] = true; held[j] = epoch; started[j] = false
      :: else
      fi;
      if
      :: flies[j] && flown[j] == epoch
      :: else ->
        if
        :: epoch == 0 -> watch_activation(j, false); flies[j] = true; flown[j] = 0
        :: else ->
          ready = true; fresh = seems_fresh; one_active = false;
          for (i : 0 .. N - 1) {
            if
            :: inside[i] && i != j ->
              same = heard[AT(j, i)] == epoch;
              if
              :: same && level[AT(j, i)] >= 2 -> started[j] = true
              :: else
              fi;
              one_active = one_active || (same && level[AT(j, i)] == 3);
#ifndef MUTATION_TAKES_FOR_GRANTED
              ready = ready && same && level[AT(j, i)] >= 1;
#endif
#ifndef MUTATION_NEVER_SILENT
              fresh = fresh && !silent[i];
#endif
            :: else
            fi
          }
          if
          :: !started[j] && decides[j] && ready && fresh ->
            watch_decision(j);
            started[j] = true
          :: else
          fi;
          if
          :: started[j] && come && (one_active || fresh) ->
            watch_activation(j, !one_active);
            flies[j] = true; flown[j] = epoch
          :: else
          fi
        fi
      fi
    fi
  :: else
  fi
}

/* The latch of a port: what its next claim would say. */
inline look(r0) {
  other = 0;
  if
  :: (r0) % 2 == 0 -> other = (mate[OWNER(r0)] == NONE -> 0 : mate[OWNER(r0)] + 1)
  :: else ->
    for (i : 0 .. N - 1) {
      if
      :: mate[i] == OWNER(r0) -> other = i + 1
      :: else
      fi
    }
  fi
}

inline claim(r0) {
  look(r0);
  if
  :: !spoken[r0] || CONTENT(r0, latest[r0]) != other ->
#ifdef MUTATION_RESTART_FORGETS
    latest[r0] = (spoken[r0] -> latest[r0] + 1 : 1);
#else
    latest[r0]++;
#endif
    CONTENT(r0, latest[r0]) = other;
    spoken[r0] = true;
    KNOWN(OWNER(r0), r0) = latest[r0]
  :: else
  fi
}

inline hear(j, m) {
  tell(m);
  heard[AT(j, m)] = said; level[AT(j, m)] = said_level;
#if LATE > 0
  past[AT(j, m)] = said != late_epoch[m] || said_level != late_level[m] || past[AT(j, m)];
#endif
  forget_heard(j, m)
}

inline stop(m) {
  live[m] = false; holds[m] = false; flies[m] = false; started[m] = false; decides[m] = false; held[m] = 0; flown[m] = 0;
  spoken[MALE(m)] = false; spoken[FEMALE(m)] = false;
  birth[MALE(m)] = latest[MALE(m)]; birth[FEMALE(m)] = latest[FEMALE(m)];
  for (i : 0 .. N - 1) { heard[AT(m, i)] = 0; level[AT(m, i)] = 0; past[AT(m, i)] = false;}
  for (r : 0 .. REGISTERS - 1) { KNOWN(m, r) = 0 }
}

/* From any state: the faults stop, and in a few rounds without loss all fly what is linked. */
inline settle() {
  for (at : 0 .. N - 1) { live[at] = true; silent[at] = false }
  for (other : 0 .. REGISTERS - 1) { turn = other; claim(turn); other = turn }
  for (k : 0 .. N - 1) {
    for (r : 0 .. REGISTERS - 1) {
      KNOWN(k, r) = (KNOWN(k, r) > latest[r] -> KNOWN(k, r) : latest[r])
    }
  }
  for (turn : 1 .. ROUNDS) {
    for (who : 0 .. N - 1) { update(who, true, true) }
    for (who : 0 .. N - 1) {
      for (whom : 0 .. N - 1) {
        if
        :: who != whom -> hear(who, whom)
        :: else
        fi
      }
    }
  }
  for (who : 0 .. N - 1) {
    for (r : 0 .. REGISTERS - 1) { version[r] = KNOWN(who, r) }
    arrange(who); take_epoch();
    if
    :: ring
    :: else -> assert(flies[who] && holds[who] && flown[who] == epoch)
    fi;
    for (i : 0 .. N - 1) {
      if
      :: inside[i] && !ring ->
        assert(flown[i] == epoch);
        assert(mate[i] == NONE || (MALE_LINKED(i) && PEER_OF_MALE(i) == mate[i]));
        assert(mate[i] != NONE || !MALE_LINKED(i))
      :: else
      fi
    }
  }
}

#define SETTLED(m) (!live[m] || (spoken[MALE(m)] && spoken[FEMALE(m)] && KNOWN(m, MALE(m)) == latest[MALE(m)] && \
  CONTENT(MALE(m), latest[MALE(m)]) == (mate[m] == NONE -> 0 : mate[m] + 1) && \
  (CONTENT(FEMALE(m), latest[FEMALE(m)]) == 0 || mate[CONTENT(FEMALE(m), latest[FEMALE(m)]) - 1] == m)))
/* A female port's claim says what is in it: with SETTLED, nothing unclaimed is. */
#define FREE(m) (mate[0] != m && mate[1] != m && mate[2] != m && (N < 4 || mate[N - 1] != m))

#define HEAR_CLAIM(r0, v) \
  :: d_step { !quiet && live[me] && OWNER(r0) != me && KNOWN(me, r0) < v && v <= latest[r0] -> KNOWN(me, r0) = v; forget(me); skip }
#ifdef MUTATION_LAST_ARRIVAL_WINS
#undef HEAR_CLAIM
#define HEAR_CLAIM(r0, v) \
  :: d_step { !quiet && live[me] && OWNER(r0) != me && v <= latest[r0] -> KNOWN(me, r0) = v; skip }
#endif
#define HEAR_CLAIMS(r0) HEAR_CLAIM(r0, 1) HEAR_CLAIM(r0, 2) HEAR_CLAIM(r0, 3) HEAR_CLAIM(r0, 4) HEAR_CLAIM(r0, 5)
#define HEAR(m) \
  :: d_step { !quiet && live[me] && live[m] && m != me && (!FEWER || held[m] == held[me]) -> hear(me, m); skip }
#define HEAR_LATE(m) \
  :: d_step { !quiet && live[me] && m != me && late_level[m] != 0 && !past[AT(me, m)] -> \
    heard[AT(me, m)] = late_epoch[m]; level[AT(me, m)] = late_level[m]; forget_heard(me, m); skip }

proctype Module(byte me) {
  do
  :: d_step { !quiet && live[me] -> claim(MALE(me)); skip }
  :: d_step { !quiet && live[me] -> claim(FEMALE(me)); skip }
  :: d_step { !quiet && live[me] -> update(me, true, true); forget(me); skip }
  :: d_step { !quiet && live[me] -> update(me, true, false); forget(me); skip }
#if FEWER == 0
  :: d_step { !quiet && live[me] -> update(me, false, true); forget(me); skip }
#endif
  HEAR_CLAIMS(0) HEAR_CLAIMS(1) HEAR_CLAIMS(2) HEAR_CLAIMS(3) HEAR_CLAIMS(4) HEAR_CLAIMS(5)
#if N > 3
  HEAR_CLAIMS(6) HEAR_CLAIMS(7)
#endif
  HEAR(0) HEAR(1) HEAR(2)
#if N > 3
  HEAR(3)
#endif
#if LATE > 0
  HEAR_LATE(0) HEAR_LATE(1) HEAR_LATE(2)
#if N > 3
  HEAR_LATE(3)
#endif
#endif
  od
}

/* Modules are alike: it makes no difference which of them dock first. */
#if LINKED == 0
#define FIRST(a, b) (docks > 0 || (a == 0 && b == 1))
#elif LINKED == 1 && N == 4
#define FIRST(a, b) (docks > 0 || undocks > 0 || crashes > 0 || (a == 1 && b == 2))
#else
#define FIRST(a, b) true
#endif
#define DOCK(a, b) \
  :: d_step { !quiet && docks < DOCKS && a != b && FIRST(a, b) && live[a] && live[b] && mate[a] == NONE && FREE(b) && \
              SETTLED(a) && SETTLED(b) -> mate[a] = b; docks++; skip }
#define UNDOCK(a) \
  :: d_step { !quiet && undocks < UNDOCKS && mate[a] != NONE && SETTLED(a) && SETTLED(mate[a]) -> \
    mate[a] = NONE; undocks++; skip }
#define FAULTS(m) \
  :: d_step { !quiet && live[m] && crashes < CRASHES -> stop(m); crashes++; skip } \
  :: d_step { !quiet && !live[m] && !silent[m] -> silent[m] = true; skip } \
  :: d_step { !quiet && !live[m] -> live[m] = true; silent[m] = false; skip }
#define KEEP(m) \
  :: d_step { !quiet && live[m] && late < LATE -> tell(m); \
    if :: said_level != 0 -> late_epoch[m] = said; late_level[m] = said_level; late++; \
       for (i : 0 .. N - 1) { past[AT(i, m)] = false } :: else fi; skip }

active proctype World() {
  d_step {
    for (r : 0 .. REGISTERS - 1) {
      latest[r] = 1; spoken[r] = true; version[r] = 1;
      for (at : 0 .. N - 1) { KNOWN(at, r) = 1 }
    }
    for (at : 0 .. N - 1) {
      mate[at] = NONE; live[at] = true; flies[at] = true; holds[at] = true;
      if
      :: at < N - 1 && (LINKED == 2 || (LINKED == 1 && at % 2 == 0)) ->
        mate[at] = at + 1; CONTENT(MALE(at), 1) = at + 2; CONTENT(FEMALE(at + 1), 1) = at + 1
      :: else
      fi
    }
    for (who : 0 .. N - 1) {
      arrange(who); take_epoch();
      held[who] = epoch; flown[who] = epoch; started[who] = epoch != 0;
      decides[who] = epoch != 0 && members[(count + 1) / 2 - 1] == who
    }
    skip
  };
  atomic { run Module(0); run Module(1); run Module(2);
#if N > 3
    run Module(3);
#endif
  }
  do
  DOCK(0, 1) DOCK(0, 2) DOCK(1, 0) DOCK(1, 2) DOCK(2, 0) DOCK(2, 1)
#if N > 3
  DOCK(0, 3) DOCK(1, 3) DOCK(2, 3) DOCK(3, 0) DOCK(3, 1) DOCK(3, 2)
#endif
  UNDOCK(0) UNDOCK(1) UNDOCK(2)
#if N > 3
  UNDOCK(3)
#endif
#if CRASHES > 0
  FAULTS(0) FAULTS(1) FAULTS(2)
#if N > 3
  FAULTS(3)
#endif
#endif
#if LATE > 0
  KEEP(0) KEEP(1) KEEP(2)
#if N > 3
  KEEP(3)
#endif
#endif
  :: d_step { !quiet -> settle(); quiet = true;
      for (r : 0 .. REGISTERS - 1) { latest[r] = 0; spoken[r] = false; birth[r] = 0 }
      for (r : 0 .. REGISTERS * VERSIONS - 1) { content[r] = 0 }
      for (r : 0 .. N * REGISTERS - 1) { known[r] = 0 }
      for (r : 0 .. N * N - 1) { heard[r] = 0; level[r] = 0; past[r] = false;}
      for (r : 0 .. N - 1) {
        mate[r] = 0; live[r] = false; silent[r] = false; holds[r] = false; flies[r] = false; started[r] = false;
        held[r] = 0; flown[r] = 0; decides[r] = false; late_epoch[r] = 0; late_level[r] = 0
      }
      docks = 0; undocks = 0; crashes = 0; late = 0; skip }
  od
}
