// SPDX-License-Identifier: BSD-3-Clause
// Reads a log of one sample per channel, written by publish_samples, with our jar as lcm-spy does: types by class
// scan, each message by its fingerprint. Exit code 1 when one is unknown, does not decode, or encodes differently.
//   java -cp lcm.jar:ladder_msgs.jar DecodeSamples.java samples.log

import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.EOFException;
import java.nio.ByteBuffer;
import java.util.Arrays;
import java.util.HashSet;
import java.util.Set;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMEncodable;
import lcm.logging.Log;
import lcm.spy.LCMTypeDatabase;

public final class DecodeSamples {
    public static void main(String[] arguments) throws Exception {
        final LCMTypeDatabase types = new LCMTypeDatabase();
        final Set<String> found = new HashSet<>();
        int messages = 0;
        int undecodable = 0;
        final Log log = new Log(arguments[0], "r");
        while (true) {
            final Log.Event event;
            try {
                event = log.readNext();
            } catch (EOFException end) {
                break;
            }
            ++messages;
            final Class<?> type = types.getClassByFingerprint(ByteBuffer.wrap(event.data).getLong());
            if (type != null && isSame(type, event.data)) {
                found.add(type.getName());
            } else {
                System.out.println("undecodable: " + event.channel);
                ++undecodable;
            }
        }
        final int expected = Integer.parseInt(arguments[1]);
        System.out.println(messages + " messages, " + found.size() + " types of " + expected + ", undecodable " + undecodable);
        System.exit(undecodable == 0 && found.size() == expected ? 0 : 1);
    }

    private static boolean isSame(Class<?> type, byte[] bytes) throws Exception {
        final Object message = type.getConstructor(java.io.DataInput.class).newInstance(new LCMDataInputStream(bytes));
        final ByteArrayOutputStream again = new ByteArrayOutputStream();
        ((LCMEncodable) message).encode(new DataOutputStream(again));
        return Arrays.equals(again.toByteArray(), bytes);
    }
}
